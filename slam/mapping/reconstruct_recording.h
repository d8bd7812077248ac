// A whole recording -> where the camera was in every frame, and the model of all of them.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "slam/mapping/pose_graph.h"
#include "slam/mapping/slam_settings.h"
#include "slam/registration/register_color.h"
#include "slam/volume/voxel_volume.h"

#include <functional>
#include <optional>
#include <vector>

namespace inlay {

/// A recording's frames, in order; each is loaded up to five times.
struct FrameSource {
    std::vector<int> numbers;                     // the recording's own
    std::vector<double> times;                    // s
    std::function<RgbdFrame(int position)> load;  // throws Error for a frame that cannot be read

    int count() const { return int(numbers.size()); }
};

/// What became of one frame.
struct ReconstructedFrame {
    int number = 0;   // the recording's own
    double time = 0;  // s
    TrackResult tracking;
    std::optional<Pose> fused_at;  // world_from_camera; empty: it is not in the model
    Rgb gain{1};                   // linear photograph / what the model's exposure would record
    bool readable = true;          // false: lost, and tracking.why says what is wrong with it
};

struct Reconstruction {
    std::vector<ReconstructedFrame> frames;
    std::vector<int> keyframes;   // positions in `frames`
    std::vector<PoseEdge> loops;  // between positions in `keyframes`, where drift was taken out
    std::optional<ColorRegistration> registration;  // empty: not asked for
    VoxelVolume volume;
    bool complete = false;  // false: stopped before its end
};

/// How often a frame is gone over.
constexpr int passes_at_most = 3;

/// Where poses come from.
enum class PoseSource { tracked, recorded };

/// Is told how many frames of a pass are done; false stops the work.
using GoOn = std::function<bool(int frames)>;

/// Tracks the recording from its first frame, as track_and_fuse() does. If the settings look ahead,
/// drift is taken out where views meet again (Gauss-Newton on keyframes), the model is fused anew
/// from the frames at full resolution and corrected poses, and every frame is tracked once more
/// against that: so early frames see what later ones found out, and lost ones may be found. How the
/// color images lie to the depth images is estimated before the second fusion, which heeds it. With
/// recorded poses, frames that have none are lost. Same bytes for any number of threads.
/// Frames that cannot be read are lost. Throws Error for settings out of range, and for depth of
/// another scale (check_depth_scale()) if the settings ask for that.
Reconstruction reconstruct_recording(const FrameSource& source, const SlamSettings& settings,
                                     PoseSource poses, const GoOn& go_on);

/// The model of those frames that say where they are fused, at full resolution. False if it was
/// stopped.
bool fuse_recording(Reconstruction& result, const FrameSource& source, const SlamSettings& settings,
                    const GoOn& go_on);

}  // namespace inlay
