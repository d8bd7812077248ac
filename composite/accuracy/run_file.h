// run.json of a bench: what an interrupted run was, so that only the same one goes on from it.
#pragma once

#include "composite/accuracy/bench.h"

namespace inlay {

struct RunFacts {
    std::string date;  // UTC, of the first start
    Machine machine;
};

/// Starts a run in `folder`, or finds the one that it holds. Throws Error (usage) where the folder
/// holds a run and `resume` is not set, or where the run it holds is another one; the message names
/// what differs.
RunFacts open_run(const std::vector<Work>& works, const BenchOptions& options,
                  const std::filesystem::path& folder);

}  // namespace inlay
