// Which frames a run composites, and how far it has to take the others.
#pragma once

#include "composite/session/session.h"

#include <string>
#include <vector>

namespace inlay {

/// Shard `text` = "I/N" (1 <= I <= N) of `frames`: the I-th of N runs of neighbors, as equal in
/// length as can be; all of them for "". Throws Error (usage).
std::vector<int> shard_of(const std::vector<int>& frames, const std::string& text);

struct FrameTask {
    int frame = 0;
    FrameWork work = FrameWork::track;
};

/// Tasks from the recording's first frame to the last that is composited. With a temporal filter
/// the frame before a composited one is sampled too, so that its bytes do not depend on the
/// selection.
std::vector<FrameTask> plan_frames(const std::vector<int>& available,
                                   const std::vector<int>& composited, bool temporal);

}  // namespace inlay
