// Where a lost camera may be.
#pragma once

#include "slam/mapping/advance_slam.h"

#include <optional>
#include <span>

namespace inlay {

/// Start poses around `pose`: itself, and turned about each axis of its camera in steps that the
/// coarsest level can bridge.
std::vector<Pose> poses_around(const Pose& pose);

/// Tries to track `observed` (a pyramid) from the last good pose, from where the camera is if it
/// went on as before (for the first half second), and from the earlier views that
/// look most like `depth`, each against the model as seen from there. A result counts if it
/// explains most of the frame; empty if none does, else the one that explains most.
std::optional<TrackResult> find_way_back(const SlamState& state,
                                         std::span<const SurfaceMap> observed,
                                         const Image<float>& depth, const SlamSettings& settings);

}  // namespace inlay
