// The step per frame: clean the depth, track the camera, fuse, and raycast the model.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "recordings/base/surface_map.h"
#include "slam/depth/filter_depth.h"
#include "slam/mapping/keyframes.h"
#include "slam/track/track_frame.h"
#include "slam/volume/fuse_depth.h"
#include "slam/volume/raycast_volume.h"

#include <optional>

namespace inlay {

struct SlamSettings {
    DepthSettings depth;
    FusionSettings fusion;
    RaycastSettings raycast;
    TrackSettings track;
};

/// Settings for --slam accurate (the defaults of every stage) and fast (larger voxels, fewer
/// iterations).
SlamSettings accurate_slam();
SlamSettings fast_slam();

/// Throws Error that names the setting which is out of range.
void validate(const SlamSettings& settings);

/// Everything that survives from frame to frame.
struct SlamState {
    VoxelVolume volume;
    std::optional<SurfaceMap> model;  // raycast from the last good pose; empty before the first
    std::optional<Pose> before_last;  // world_from_camera of the good frame before it
    std::vector<Keyframe> keyframes;  // for finding the way back
    int frames_lost = 0;              // since the last good one
};

struct SlamStep {
    TrackResult tracking;
    SurfaceMap surface;
};

SlamState start_slam(const SlamSettings& settings);

/// One frame. With a known pose nothing is tracked. Else the first frame is anchored at its
/// recorded pose, or at the identity, and every later one is tracked against the model; recorded
/// poses are not used again. The surface is the model as this frame's lens (distortion included)
/// sees it from there, completed by the frame's own depth where the model has none. A frame that is
/// lost changes nothing in the model: its pose is the last good one, its surface has confidence 0,
/// and the following frames look for the way back from there and from earlier views.
/// Throws Error if the frame's images do not have the lens's size.
SlamStep advance_slam(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                      const std::optional<Pose>& known_world_from_camera);

}  // namespace inlay
