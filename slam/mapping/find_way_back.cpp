#include "slam/mapping/find_way_back.h"

#include "slam/track/se3.h"

#include <algorithm>

namespace inlay {
namespace {

constexpr double turn = 0.1;           // rad, about what the coarsest level can bridge
constexpr int turns = 2;               // in each direction
constexpr int views_tried = 4;         // per frame
constexpr float least_overlap = 0.3f;  // of the frame with the model, to believe in it

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
    TrackSettings strict = settings.track;
    strict.least_overlap = std::max(strict.least_overlap, least_overlap);
    const auto tried = [&](const SurfaceMap& model) {
        const TrackResult result =
            track_frame(observed, model, poses_around(model.world_from_camera), strict);
        return result.status == TrackingStatus::tracked ? std::optional(result) : std::nullopt;
    };
    if (const auto found = tried(*state.model)) return found;
    for (const Pose& view : similar_views(state.keyframes, depth, views_tried)) {
        const SurfaceMap model =
            raycast_volume(state.volume, observed.front().lens, view, settings.raycast);
        if (const auto found = tried(model)) return found;
    }
    return std::nullopt;
}

}  // namespace inlay
