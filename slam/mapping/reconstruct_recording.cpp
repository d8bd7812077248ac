#include "slam/mapping/reconstruct_recording.h"

#include "recordings/base/check.h"
#include "slam/landmarks/find_landmarks.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/color_camera.h"
#include "slam/mapping/depth_scale.h"
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
constexpr int calm_reach = 2;               // frames before and after one

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

/// The last fused frame as a view for loops, which only tracked poses need.
LoopView view_of(const SlamState& state, const Pose& world_from_camera, PoseSource poses) {
    if (poses == PoseSource::recorded) return {{}, world_from_camera};
    Image<float> depth(state.seen->lens.width, state.seen->lens.height);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i)
        depth.pixels[i] = state.seen->position.pixels[i].z;
    return make_loop_view(*state.seen, world_from_camera,
                          find_landmarks(state.photograph, depth, state.seen->lens));
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
    result.gain = state.exposure.gain;
    if (!is_lost(result) && state.fused) result.fused_at = result.tracking.world_from_camera;
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
        if (pass.result.frames.back().fused_at &&
            shows_more(pass.views, tracking.world_from_camera)) {
            pass.result.keyframes.push_back(i);
            pass.views.push_back(view_of(state, tracking.world_from_camera, poses));
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
TrackResult track_again(const Reconstruction& before, std::size_t i, const ObservedFrame& observed,
                        const SlamSettings& settings) {
    const bool lost = is_lost(before.frames[i]);
    const std::vector<Pose> starts =
        lost ? neighbours_of(before, i)
             : std::vector<Pose>{before.frames[i].tracking.world_from_camera};
    for (const Pose& start : starts) {
        const SurfaceMap model =
            raycast_volume(before.volume, observed.pyramid.front().lens, start, settings.raycast);
        const TrackResult found =
            track_frame(observed.pyramid, model, std::span(&start, 1), settings.track);
        if (found.status == TrackingStatus::tracked) return found;
    }
    return before.frames[i].tracking;
}

/// The photograph of the frame at a position, as the color camera took it.
SeenColor color_of(const Reconstruction& result, std::size_t i, const RgbdFrame& frame) {
    const ColorCamera camera = color_camera_of(result, int(i), frame.lens);
    return {frame.color, camera.lens, camera.color_from_depth};
}

/// What the finished model says of a frame: where its camera was, and how it was exposed.
struct LastLook {
    TrackResult tracking;
    Exposure exposure;
};

LastLook last_look(const Reconstruction& before, std::size_t i, const RgbdFrame& frame,
                   const SlamSettings& settings, PoseSource poses) {
    ObservedFrame observed = observe_frame(frame, settings);
    LastLook look{before.frames[i].tracking, {}};
    if (poses == PoseSource::tracked) look.tracking = track_again(before, i, observed, settings);
    if (!settings.follow_exposure || look.tracking.status == TrackingStatus::lost) return look;
    SurfaceMap& seen = observed.pyramid.front();
    seen.world_from_camera = look.tracking.world_from_camera;
    look.exposure = measure_exposure(before.volume, seen, color_of(before, i, frame));
    return look;
}

/// The median of each frame's gain and those of its neighbours, so that virtual objects do not
/// flicker with what single frames get wrong.
void calm_gains(std::vector<ReconstructedFrame>& frames) {
    std::vector<Rgb> gains;
    for (const ReconstructedFrame& frame : frames)
        gains.push_back(frame.gain);
    const int last = int(gains.size()) - 1;
    for (int i = 0; i <= last; ++i) {
        const int reach = std::min({calm_reach, i, last - i});
        for (int channel = 0; channel < 3; ++channel) {
            std::vector<float> around;
            for (int j = i - reach; j <= i + reach; ++j)
                around.push_back(gains[std::size_t(j)][channel]);
            std::nth_element(around.begin(), around.begin() + reach, around.end());
            frames[std::size_t(i)].gain[channel] = around[std::size_t(reach)];
        }
    }
}

/// Looks at every frame once more with the finished model. False if it was stopped.
bool last_pass(Reconstruction& result, const FrameSource& source, const SlamSettings& settings,
               PoseSource poses, const GoOn& go_on) {
    const Reconstruction& before = result;
    std::vector<LastLook> looks;
    for (int i = 0; i < source.count(); ++i) {
        const ReconstructedFrame& frame = before.frames[std::size_t(i)];
        looks.push_back(frame.readable
                            ? last_look(before, std::size_t(i), source.load(i), settings, poses)
                            : LastLook{frame.tracking, {}});
        if (!go_on(i + 1)) return false;
    }
    Exposure exposure;
    for (std::size_t i = 0; i < looks.size(); ++i) {
        result.frames[i].tracking = looks[i].tracking;
        update_exposure(exposure, looks[i].exposure);
        result.frames[i].gain = exposure.gain;
    }
    calm_gains(result.frames);
    return true;
}

}  // namespace

bool fuse_recording(Reconstruction& result, const FrameSource& source, const SlamSettings& settings,
                    const GoOn& go_on) {
    result.volume = make_volume(settings.fusion);
    Exposure exposure;
    for (std::size_t i = 0; i < result.frames.size(); ++i) {
        if (const std::optional<Pose>& pose = result.frames[i].fused_at) {
            const RgbdFrame frame = source.load(int(i));
            const SurfaceMap seen = own_surface(frame, *pose, settings.depth);
            SeenColor color = color_of(result, i, frame);
            if (settings.follow_exposure)
                update_exposure(exposure, measure_exposure(result.volume, seen, color));
            color.gain = exposure.measured;
            fuse_surface(result.volume, seen, color, settings.fusion);
        }
        if (!go_on(int(i) + 1)) return false;
    }
    return true;
}

Reconstruction reconstruct_recording(const FrameSource& source, const SlamSettings& settings,
                                     PoseSource poses, const GoOn& go_on) {
    validate(settings);
    if (settings.check_scale) check_depth_scale(source);
    if (!settings.look_ahead) return first_pass(source, settings, poses, go_on).result;
    const SlamSettings first = first_pass_of(settings);
    FirstPass pass = first_pass(source, first, poses, go_on);
    Reconstruction& result = pass.result;
    if (!result.complete) return std::move(result);
    if (poses == PoseSource::tracked) close_loops(pass, first.track);
    pass.views.clear();
    result.volume = {};  // room for what follows
    for (ReconstructedFrame& frame : result.frames)
        if (frame.fused_at) frame.fused_at = frame.tracking.world_from_camera;  // loops moved it
    if (settings.register_color) result.registration = register_recording(result, source, settings);
    result.complete = fuse_recording(result, source, settings, go_on);
    if (!result.complete) return std::move(result);
    if (poses == PoseSource::recorded && !settings.follow_exposure) return std::move(result);
    SlamSettings last = settings;
    last.track.noisy_angle = settings.track.coarse_angle;  // the model has its noise behind it
    result.complete = last_pass(result, source, last, poses, go_on);
    return std::move(result);
}

}  // namespace inlay
