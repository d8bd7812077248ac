// Benchmarks whose best times are kept, so that a run can end with their ratios.
#pragma once

#include <functional>
#include <string>

namespace inlay {

/// What a body goes through: shown as a count, and per second.
struct Amount {
    std::string of;  // "rays", "bytes"; empty: not counted
    double count = 0;
};

/// Registers `body`, to run on `threads` threads; `iterations` 0: as often as Google Benchmark
/// wants.
void add_benchmark(const std::string& name, int threads, const Amount& amount,
                   const std::function<void()>& body, int iterations = 0);

/// Prints the best time of `above` over that of `below`, if both were run.
void print_ratio(const std::string& above, const std::string& below);

}  // namespace inlay
