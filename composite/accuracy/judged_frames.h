// Which frames of a work are measured, and what judges them.
#pragma once

#include "composite/accuracy/knobs.h"
#include "composite/accuracy/unit.h"

#include <functional>
#include <vector>

namespace inlay {

/// The frames with truth (or all, where none has), of these the wanted ones; without a wish the
/// first and the last of those that have a frame before them, if there are any. A scene has its one
/// view, 0. Throws Error (usage) when none is left.
std::vector<int> measured_frames(const Work& work, const std::function<bool(int)>& wanted);

/// Tracks the frames and those before them under one reconstruction's settings. The frame before
/// stands only where the loop would use it: no virtual object moved in between.
/// `converged_samples` 0: no converged reference.
std::vector<JudgedFrame> judge_frames(const Work& work, const std::vector<int>& frames,
                                      const Sampling& sampling, int converged_samples);

}  // namespace inlay
