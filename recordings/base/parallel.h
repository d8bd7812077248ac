// The only threading in the library. Results never depend on the number of threads.
#pragma once

#include <functional>

namespace inlay {

/// Sets how many threads the functions below use; 0 = all cores. Call once, before any of them.
void set_thread_count(int threads);

/// Calls body(i) for every i in [0, count), in any order, on several threads.
void parallel_for(int count, const std::function<void(int)>& body);

/// Calls body(y) for every row of an image.
inline void parallel_rows(int height, const std::function<void(int)>& body) {
    parallel_for(height, body);
}

/// The sum of term(i) for i in [0, count): terms are computed in parallel, added in order.
double ordered_sum(int count, const std::function<double(int)>& term);

}  // namespace inlay
