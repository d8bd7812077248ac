#include "recordings/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <numeric>
#include <vector>

namespace inlay {
namespace {

bool one_thread = false;

}  // namespace

void set_thread_count(int threads) {
    one_thread = threads == 1;
    static std::unique_ptr<tbb::global_control> limit;
    limit.reset();
    if (threads > 0) {
        limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                      std::size_t(threads));
    }
}

void parallel_for(int count, const std::function<void(int)>& body) {
    if (one_thread) {  // a plain loop, in the caller's floating-point environment
        for (int i = 0; i < count; ++i)
            body(i);
        return;
    }
    tbb::parallel_for(0, count, [&](int i) { body(i); });
}

double ordered_sum(int count, const std::function<double(int)>& term) {
    std::vector<double> terms(std::size_t(count), 0.0);
    parallel_for(count, [&](int i) { terms[std::size_t(i)] = term(i); });
    return std::accumulate(terms.begin(), terms.end(), 0.0);
}

}  // namespace inlay
