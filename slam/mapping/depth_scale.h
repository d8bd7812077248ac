// Depth that was stored in other units than it is read in.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/mapping/reconstruct_recording.h"

#include <optional>

namespace inlay {

/// Depth cameras of rooms measure from some 0.3 m on, and mostly nearer than 4 m. Throws Error (bad
/// data) that says so if what some frames of the recording measured is nearer or farther than that:
/// then most likely its scale is wrong. It is a guess: a wrong scale may look like another room.
/// Frames that cannot be read do not count.
void check_depth_scale(const FrameSource& source);

/// How many times farther away a frame's surfaces are than those of the model at the same pixels,
/// if nearly all are so by the same factor, which is none that a camera's motion explains.
std::optional<float> other_scale(const SurfaceMap& observed, const SurfaceMap& model);

}  // namespace inlay
