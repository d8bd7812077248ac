// How tracking and fusing go: a struct for each stage.
#pragma once

#include "slam/depth/filter_depth.h"
#include "slam/edges/follow_photograph.h"
#include "slam/track/track_frame.h"
#include "slam/volume/fuse_depth.h"
#include "slam/volume/raycast_volume.h"

namespace inlay {

struct SlamSettings {
    DepthSettings depth;
    FusionSettings fusion;
    RaycastSettings raycast;
    TrackSettings track;
    EdgeSettings edges;
    bool half_resolution = false;  // of depth, for tracking, and for fusing as frames come
    bool look_ahead = true;        // reconstruct_recording() goes over the recording again,
    bool register_color = true;    // and then aligns color with depth where a check says so
    bool check_scale = true;       // of depth, before a recording is reconstructed
    bool follow_exposure = true;   // measures how the camera's exposure changes
};

/// Settings for --slam accurate (the defaults of every stage) and fast (half resolution, larger
/// voxels, fewer iterations, one pass).
SlamSettings accurate_slam();
SlamSettings fast_slam();

/// Of the first pass of a reconstruction that looks ahead: as fast, with voxels of the same order.
SlamSettings first_pass_of(const SlamSettings& settings);

/// Throws Error that names the setting which is out of range.
void validate(const SlamSettings& settings);

}  // namespace inlay
