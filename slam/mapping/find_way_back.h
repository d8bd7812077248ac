// Where a lost camera may be.
#pragma once

#include "slam/mapping/advance_slam.h"
#include "slam/mapping/observe_frame.h"

#include <optional>
#include <span>

namespace inlay {

/// Start poses around `pose`: itself, and turned about each axis of its camera in steps that the
/// coarsest level can bridge.
std::vector<Pose> poses_around(const Pose& pose);

/// Tries to track `observed` from where landmarks of the photograph place it among earlier views;
/// from the last good pose; from where the camera is if it went on as before (for the first half
/// second); and from the earlier views whose depth looks most like its own; each against the model
/// as seen from there. A result counts if it explains most of the frame; empty if none does, else
/// the one that explains most. Landmarks that lead to a result have the last word.
std::optional<TrackResult> find_way_back(const SlamState& state, const ObservedFrame& observed,
                                         const Image<EncodedRgb>& photo,
                                         const SlamSettings& settings);

}  // namespace inlay
