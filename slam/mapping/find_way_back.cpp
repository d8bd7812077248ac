#include "slam/mapping/find_way_back.h"

#include "slam/track/se3.h"

namespace inlay {
namespace {

constexpr double turn = 0.1;            // rad, about what the coarsest level can bridge
constexpr int turns = 2;                // in each direction
constexpr int most_frames_ahead = 15;   // that a motion is believed to go on
constexpr int views_tried = 4;          // per frame
constexpr float least_overlap = 0.5f;   // of the frame with the model, to believe in it
constexpr float least_inliers = 0.75f;  // share of the overlap

/// The share of the frame's points that a result explains.
float explained(const TrackResult& result) { return result.inlier_share * result.overlap; }

/// Where the camera is if it went on as before it was lost.
Pose gone_on(const SlamState& state) {
    const Pose& last = state.model->world_from_camera;
    if (!state.before_last) return last;
    Twist motion = logarithm(inverse(*state.before_last) * last);
    motion.rotation *= state.frames_lost + 1;
    motion.translation *= state.frames_lost + 1;
    return last * exponential(motion);
}

}  // namespace

std::vector<Pose> poses_around(const Pose& pose) {
    std::vector<Pose> poses{pose};
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = -turns; i <= turns; ++i) {
            if (i == 0) continue;
            Twist twist;
            twist.rotation[axis] = i * turn;
            poses.push_back(pose * exponential(twist));
        }
    }
    return poses;
}

std::optional<TrackResult> find_way_back(const SlamState& state,
                                         std::span<const SurfaceMap> observed,
                                         const Image<float>& depth, const SlamSettings& settings) {
    std::optional<TrackResult> best;
    const auto attempt = [&](const SurfaceMap& model) {
        const TrackResult result =
            track_frame(observed, model, poses_around(model.world_from_camera), settings.track);
        if (result.status != TrackingStatus::tracked || result.overlap < least_overlap ||
            result.inlier_share < least_inliers) {
            return;
        }
        if (!best || explained(result) > explained(*best)) best = result;
    };
    const auto attempt_from = [&](const Pose& view) {
        attempt(raycast_volume(state.volume, observed.front().lens, view, settings.raycast));
    };
    attempt(*state.model);
    if (state.frames_lost > 0 && state.frames_lost < most_frames_ahead)
        attempt_from(gone_on(state));
    for (const Pose& view : similar_views(state.keyframes, depth, views_tried)) {
        attempt_from(view);
    }
    return best;
}

}  // namespace inlay
