// One frame's geometry, as far as it can be trusted.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "recordings/base/surface_map.h"
#include "slam/mapping/slam_settings.h"

#include <vector>

namespace inlay {

struct ObservedFrame {
    Image<float> clean;               // m, at the finest level
    std::vector<SurfaceMap> pyramid;  // of the smoothed depth, finest first, in the camera's frame
};

/// For tracking: cleaned, halved if the settings ask for it, smoothed by half of the radius, and a
/// pyramid of settings.track.levels. Images of less than 320 px across are not halved, and smoothed
/// by all of it.
/// Throws Error if the frame's images do not have the lens's size.
ObservedFrame observe_frame(const RgbdFrame& frame, const SlamSettings& settings);

/// What a frame saw from a pose, at full size.
SurfaceMap own_surface(const RgbdFrame& frame, const Pose& world_from_camera,
                       const DepthSettings& settings);

}  // namespace inlay
