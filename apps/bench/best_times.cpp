#include "apps/bench/best_times.h"

#include "recordings/base/parallel.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>

namespace inlay {
namespace {

/// By name, in ms.
std::map<std::string, double>& best_times() {
    static std::map<std::string, double> times;
    return times;
}

}  // namespace

void add_benchmark(const std::string& name, int threads, const Amount& amount,
                   const std::function<void()>& body, int iterations) {
    auto* added = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        set_thread_count(threads);
        double& best = best_times().try_emplace(name, 1e300).first->second;
        for (auto _ : state) {
            const auto start = std::chrono::steady_clock::now();
            body();
            const std::chrono::duration<double> s = std::chrono::steady_clock::now() - start;
            state.SetIterationTime(s.count());
            best = std::min(best, 1e3 * s.count());
        }
        if (amount.of.empty()) return;
        state.counters[amount.of] = benchmark::Counter(amount.count);
        state.counters[amount.of + "/s"] =
            benchmark::Counter(amount.count, benchmark::Counter::kIsIterationInvariantRate);
    });
    added->Unit(benchmark::kMillisecond)->UseManualTime();
    if (iterations > 0) added->Iterations(iterations);
}

void print_ratio(const std::string& above, const std::string& below) {
    const auto& times = best_times();
    const auto a = times.find(above), b = times.find(below);
    if (a == times.end() || b == times.end()) return;
    std::cout << above << " / " << below << ": " << a->second / b->second << "\n";
}

}  // namespace inlay
