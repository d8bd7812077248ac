// Cost: wall time, processor time and memory of a piece of work.
#pragma once

#include <chrono>

namespace inlay {

struct Cost {
    double wall_ms = 0;
    double cpu_ms = 0;  // of all threads
    Cost& operator+=(const Cost& more) {
        wall_ms += more.wall_ms;
        cpu_ms += more.cpu_ms;
        return *this;
    }
};

class CostWatch {
public:
    CostWatch();
    /// Since it was made or last asked.
    Cost lap();

private:
    std::chrono::steady_clock::time_point wall_;
    double cpu_ms_;
};

/// Largest memory the process has held so far, MB.
double peak_memory_mb();

}  // namespace inlay
