// What a run says of one work, from its finished measurements.
#pragma once

#include "composite/accuracy/bench.h"

namespace inlay {

/// The frames under the program's own settings, and the finished units of all works.
struct WorkMeasurements {
    const std::vector<JudgedFrame>& frames;
    const std::vector<UnitRun>& units;
};

/// Cells, pictures (which are written into `folder` too) and, where the options ask for it, blame,
/// budgets and the estimate without truth. A frame over its budget is warned of, with the stage to
/// blame.
WorkReport report_work(const Work& work, const WorkMeasurements& measured,
                       const BenchOptions& options, const std::filesystem::path& folder,
                       const BenchWatcher& watcher);

}  // namespace inlay
