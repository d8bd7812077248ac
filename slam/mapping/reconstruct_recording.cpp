#include "slam/mapping/reconstruct_recording.h"

#include "recordings/base/check.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/color_camera.h"
#include "slam/mapping/find_loops.h"
#include "slam/mapping/observe_frame.h"
#include "slam/track/se3.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace inlay {
namespace {

constexpr double keyframe_distance = 0.25;  // m, from a keyframe to the next
constexpr double keyframe_angle = 0.2;      // rad
constexpr double drift_distance = 0.03;     // m, less is left to the depth sensor's own bends
constexpr double drift_angle = 0.03;        // rad

bool is_lost(const ReconstructedFrame& frame) {
    return frame.tracking.status == TrackingStatus::lost;
}

/// The first pass, from frame to frame, with the views that loops may join.
struct FirstPass {
    Reconstruction result;
    std::vector<LoopView> views;  // one for each keyframe
};

TrackResult track_next(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                       PoseSource poses) {
    if (poses == PoseSource::tracked) return track_and_fuse(state, frame, settings, std::nullopt);
    if (frame.recorded_world_from_camera)
        return track_and_fuse(state, frame, settings, frame.recorded_world_from_camera);
    TrackResult lost;
    lost.why = "it has no usable recorded pose";
    if (state.model) lost.world_from_camera = state.model->world_from_camera;
    return lost;
}

/// Whether a view is far enough from the last keyframe to be the next.
bool shows_more(const std::vector<LoopView>& views, const Pose& world_from_camera) {
    if (views.empty()) return true;
    const Pose& last = views.back().world_from_camera;
    return glm::length(last.translation - world_from_camera.translation) > keyframe_distance ||
           rotation_angle(last, world_from_camera) > keyframe_angle;
}

/// Tracks the next frame; one that cannot be read stays where the camera was.
ReconstructedFrame first_look(SlamState& state, const FrameSource& source, int position,
                              const SlamSettings& settings, PoseSource poses) {
    ReconstructedFrame result;
    result.number = source.numbers[std::size_t(position)];
    result.time = source.times[std::size_t(position)];
    try {
        result.tracking = track_next(state, source.load(position), settings, poses);
    } catch (const Error& error) {
        result.readable = false;
        result.tracking = TrackResult{};
        result.tracking.why = error.what();
        if (state.model) result.tracking.world_from_camera = state.model->world_from_camera;
    }
    return result;
}

FirstPass first_pass(const FrameSource& source, const SlamSettings& settings, PoseSource poses,
                     const GoOn& go_on) {
    FirstPass pass;
    SlamState state = start_slam(settings);
    pass.result.complete = true;
    for (int i = 0; i < source.count() && pass.result.complete; ++i) {
        pass.result.frames.push_back(first_look(state, source, i, settings, poses));
        const TrackResult& tracking = pass.result.frames.back().tracking;
        if (tracking.status != TrackingStatus::lost &&
            shows_more(pass.views, tracking.world_from_camera)) {
            pass.result.keyframes.push_back(i);
            pass.views.push_back(make_loop_view(*state.seen, tracking.world_from_camera));
        }
        pass.result.complete = go_on(i + 1);
    }
    pass.result.volume = std::move(state.volume);
    return pass;
}

/// Moves every frame with the keyframes around it: between two by a share of both their moves.
void follow_keyframes(Reconstruction& result, const std::vector<Pose>& moves) {
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
        const auto after =
            std::upper_bound(result.keyframes.begin(), result.keyframes.end(), int(i));
        const auto second = std::size_t(std::min<std::ptrdiff_t>(
            after - result.keyframes.begin(), std::ptrdiff_t(result.keyframes.size()) - 1));
        const std::size_t first =
            second > 0 && after != result.keyframes.end() ? second - 1 : second;
        const int from = result.keyframes[first], to = result.keyframes[second];
        const double share = to > from ? double(int(i) - from) / double(to - from) : 0;
        const Twist between = logarithm(moves[second] * inverse(moves[first]));
        Pose& pose = result.frames[i].tracking.world_from_camera;
        pose =
            orthonormalized(exponential({share * between.rotation, share * between.translation}) *
                            moves[first] * pose);
    }
}

/// Takes out drift where views meet again and motions measured between views contradict the poses:
/// loops, or the chain where the camera was drawn back at a loop's end. Where they agree with them
/// within what the sensor's own bends explain, tracking against the model knows better.
void close_loops(FirstPass& pass, const TrackSettings& settings) {
    std::vector<PoseEdge> loops = find_loops(pass.views, settings);
    if (loops.empty()) return;
    std::vector<PoseEdge> edges = chain_edges(pass.views, settings);
    edges.insert(edges.end(), loops.begin(), loops.end());
    const bool drifted = std::any_of(edges.begin(), edges.end(), [&](const PoseEdge& edge) {
        const LoopError error = loop_error(edge, pass.views);
        return error.distance > drift_distance || error.angle > drift_angle;
    });
    if (!drifted) return;
    std::vector<Pose> poses;
    for (const LoopView& view : pass.views)
        poses.push_back(view.world_from_camera);
    optimize_poses(poses, edges);
    for (std::size_t i = 0; i < poses.size(); ++i)
        poses[i] = poses[i] * inverse(pass.views[i].world_from_camera);  // the move, in the world
    follow_keyframes(pass.result, poses);
    pass.result.loops = std::move(loops);
}

/// Poses around a frame that is lost: those of the good frames before and after it.
std::vector<Pose> neighbours_of(const Reconstruction& result, std::size_t lost) {
    std::vector<Pose> poses;
    for (std::size_t i = lost; i-- > 0;) {
        if (is_lost(result.frames[i])) continue;
        poses.push_back(result.frames[i].tracking.world_from_camera);
        break;
    }
    for (std::size_t i = lost + 1; i < result.frames.size(); ++i) {
        if (is_lost(result.frames[i])) continue;
        poses.push_back(result.frames[i].tracking.world_from_camera);
        break;
    }
    return poses;
}

/// Tracks a frame against the finished model; keeps what it had where that fails.
TrackResult track_again(const Reconstruction& before, std::size_t i, const RgbdFrame& frame,
                        const SlamSettings& settings) {
    const bool lost = is_lost(before.frames[i]);
    const std::vector<Pose> starts =
        lost ? neighbours_of(before, i)
             : std::vector<Pose>{before.frames[i].tracking.world_from_camera};
    const ObservedFrame observed = observe_frame(frame, settings);
    TrackResult best = before.frames[i].tracking;
    for (const Pose& start : starts) {
        const SurfaceMap model =
            raycast_volume(before.volume, observed.pyramid.front().lens, start, settings.raycast);
        const TrackResult found =
            track_frame(observed.pyramid, model, std::span(&start, 1), settings.track);
        if (found.status == TrackingStatus::tracked) return found;
    }
    return best;
}

bool second_pass(Reconstruction& result, const FrameSource& source, const SlamSettings& settings,
                 const GoOn& go_on) {
    const Reconstruction& before = result;
    std::vector<TrackResult> after;
    for (int i = 0; i < source.count(); ++i) {
        const ReconstructedFrame& frame = before.frames[std::size_t(i)];
        after.push_back(frame.readable
                            ? track_again(before, std::size_t(i), source.load(i), settings)
                            : frame.tracking);
        if (!go_on(i + 1)) return false;
    }
    for (std::size_t i = 0; i < after.size(); ++i)
        result.frames[i].tracking = after[i];
    return true;
}

}  // namespace

bool fuse_recording(Reconstruction& result, const FrameSource& source, const SlamSettings& settings,
                    const GoOn& go_on) {
    result.volume = make_volume(settings.fusion);
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
        if (const std::optional<Pose>& pose = result.frames[i].fused_at) {
            const RgbdFrame frame = source.load(int(i));
            const ColorCamera camera = color_camera_of(result, int(i), frame.lens);
            fuse_surface(result.volume, own_surface(frame, *pose, settings.depth),
                         {frame.color, camera.lens, camera.color_from_depth}, settings.fusion);
        }
        if (!go_on(int(i) + 1)) return false;
    }
    return true;
}

Reconstruction reconstruct_recording(const FrameSource& source, const SlamSettings& settings,
                                     PoseSource poses, const GoOn& go_on) {
    validate(settings);
    if (!settings.look_ahead) return first_pass(source, settings, poses, go_on).result;
    const SlamSettings first = first_pass_of(settings);
    FirstPass pass = first_pass(source, first, poses, go_on);
    Reconstruction& result = pass.result;
    if (!result.complete) return std::move(result);
    if (poses == PoseSource::tracked) close_loops(pass, first.track);
    pass.views.clear();
    result.volume = {};  // room for what follows
    for (ReconstructedFrame& frame : result.frames)
        if (!is_lost(frame)) frame.fused_at = frame.tracking.world_from_camera;
    if (settings.register_color) result.registration = register_recording(result, source, settings);
    result.complete = fuse_recording(result, source, settings, go_on);
    if (result.complete && poses == PoseSource::tracked) {
        SlamSettings second = settings;
        second.track.noisy_angle =
            settings.track.coarse_angle;  // the model has its noise behind it
        result.complete = second_pass(result, source, second, go_on);
    }
    return std::move(result);
}

}  // namespace inlay
