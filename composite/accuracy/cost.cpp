#include "composite/accuracy/cost.h"

#include <sys/resource.h>

#include <ctime>

namespace inlay {
namespace {

double process_cpu_ms() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

}  // namespace

CostWatch::CostWatch() : wall_(std::chrono::steady_clock::now()), cpu_ms_(process_cpu_ms()) {}

Cost CostWatch::lap() {
    const auto now = std::chrono::steady_clock::now();
    const double cpu = process_cpu_ms();
    const Cost cost{std::chrono::duration<double, std::milli>(now - wall_).count(), cpu - cpu_ms_};
    wall_ = now;
    cpu_ms_ = cpu;
    return cost;
}

double peak_memory_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024;  // kB
}

}  // namespace inlay
