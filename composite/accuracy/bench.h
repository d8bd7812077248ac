// The bench: every method and knob on every work, in interleaved order, kept unit by unit.
#pragma once

#include "composite/accuracy/accuracy_json.h"

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace inlay {

struct BenchOptions {
    Settings settings;
    int repeats = 3;
    bool quick = false;                     // few knobs and samples, one repeat is usual
    std::vector<std::string> only;          // names of methods and knobs; empty: all
    std::function<bool(int)> wanted_frame;  // empty: two of each work
    int converged_samples = 2048;           // per pixel, of the reference
    bool blame = true;                      // budgets, and the estimate without truth too
    bool resume = false;
    std::string program;  // version, for the report
};

/// What a run tells while it goes on, and asks.
struct BenchWatcher {
    std::function<void(int done, int of)> units_done;
    std::function<void(const std::string&)> warn;
    std::function<bool()> interrupted;
};

/// Throws Error (usage) for names that are no method and no knob, repeats below 1, and settings out
/// of range.
void validate(const BenchOptions& options);

struct BenchResult {
    AccuracyReport report;
    bool complete = true;
};

/// Measures `works` and returns the report; each finished unit is a file in `folder`/units. An
/// interrupted run returns what is finished with `complete` false; with `resume` the next one
/// measures only what is missing, and is refused (Error, usage) when works or what their files
/// hold, frames, settings or knobs have changed.
BenchResult run_bench(const std::vector<Work>& works, const BenchOptions& options,
                      const std::filesystem::path& folder, const BenchWatcher& watcher);

}  // namespace inlay
