// The step per frame: clean the depth, track the camera, fuse, and raycast the model.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "recordings/base/surface_map.h"
#include "slam/exposure/measure_exposure.h"
#include "slam/mapping/keyframes.h"
#include "slam/mapping/slam_settings.h"
#include "slam/volume/voxel_volume.h"

#include <optional>

namespace inlay {

/// Everything that survives from frame to frame.
struct SlamState {
    VoxelVolume volume;
    std::optional<SurfaceMap> seen;  // what the last fused frame itself saw; empty before the first
    std::optional<SurfaceMap> model;  // raycast from the pose of the last frame that is not lost
    Image<EncodedRgb> photograph;     // taken there; empty if that frame was not fused
    std::optional<Pose> before_last;  // world_from_camera of the frame before, if neither was lost
    bool fused = false;               // whether the last frame is in the model
    std::vector<Keyframe> keyframes;  // for finding the way back
    int frames_lost = 0;              // since the last good one
    Exposure exposure;                // of the last frame that could tell
};

struct SlamStep {
    TrackResult tracking;
    SurfaceMap surface;
    Rgb gain{1};  // linear photograph / what the model's exposure would have recorded
};

SlamState start_slam(const SlamSettings& settings);

/// Tracks one frame and fuses it. With a known pose nothing is tracked. Else the first frame is
/// anchored at its recorded pose, or at the identity, and every later one is tracked against the
/// model; recorded poses are not used again. Frames are fused if their pose can be trusted: if they
/// are tracked, or weakly so and where the camera was expected: gone on, or where the frame before
/// had it, weak or not. A frame that is lost has the last good pose, and the following frames look
/// for the way back from there and from earlier views. Throws Error if the frame's images do not
/// have the lens's size.
TrackResult track_and_fuse(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                           const std::optional<Pose>& known_world_from_camera);

/// track_and_fuse(), and what the frame's lens (distortion included) sees of the model from there:
/// completed by the frame's own depth where the model has none; of confidence 0 if it is lost.
SlamStep advance_slam(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                      const std::optional<Pose>& known_world_from_camera);

}  // namespace inlay
