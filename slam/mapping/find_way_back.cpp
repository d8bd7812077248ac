#include "slam/mapping/find_way_back.h"

#include "slam/landmarks/find_landmarks.h"
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

std::optional<TrackResult> find_way_back(const SlamState& state, const ObservedFrame& observed,
                                         const Image<EncodedRgb>& photo,
                                         const SlamSettings& settings) {
    const Lens& lens = observed.pyramid.front().lens;
    std::optional<TrackResult> best;
    const auto attempt = [&](const SurfaceMap& model, std::span<const Pose> starts) {
        const TrackResult result = track_frame(observed.pyramid, model, starts, settings.track);
        if (result.status != TrackingStatus::tracked || result.overlap < least_overlap ||
            result.inlier_share < least_inliers) {
            return;
        }
        if (!best || explained(result) > explained(*best)) best = result;
    };
    const auto seen_from = [&](const Pose& view) {
        return raycast_volume(state.volume, lens, view, settings.raycast);
    };
    const Landmarks landmarks = find_landmarks(photo, observed.clean, lens);
    for (const Pose& pose : poses_by_landmarks(state.keyframes, landmarks, views_tried))
        attempt(seen_from(pose), std::span(&pose, 1));
    if (best) return best;
    attempt(*state.model, poses_around(state.model->world_from_camera));
    std::vector<Pose> views = similar_views(state.keyframes, observed.clean, views_tried);
    if (state.frames_lost > 0 && state.frames_lost < most_frames_ahead)
        views.insert(views.begin(), gone_on(state));
    for (const Pose& view : views)
        attempt(seen_from(view), poses_around(view));
    return best;
}

}  // namespace inlay
