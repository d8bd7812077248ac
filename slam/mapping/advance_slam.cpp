#include "slam/mapping/advance_slam.h"

#include "slam/landmarks/find_landmarks.h"
#include "slam/mapping/depth_scale.h"
#include "slam/mapping/find_way_back.h"
#include "slam/mapping/observe_frame.h"
#include "slam/mapping/see_model.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace inlay {
namespace {

constexpr double expected_distance = 0.03;  // m, of a weak frame from where it is expected
constexpr double expected_angle = 0.05;     // rad

TrackResult certain(const Pose& world_from_camera) {
    return {world_from_camera, TrackingStatus::tracked, 1, 0, 0, 1};
}

/// Where the camera may be now: gone on as before, or standing still.
std::vector<Pose> predictions(const SlamState& state) {
    const Pose& last = state.model->world_from_camera;
    if (!state.before_last) return {last};
    return {last * (inverse(*state.before_last) * last), last};
}

TrackResult track(const SlamState& state, const RgbdFrame& frame, const ObservedFrame& observed,
                  const SlamSettings& settings) {
    TrackResult result;
    if (state.frames_lost == 0) {
        const Photographs photographs{frame.color, state.photograph};
        result = track_frame(observed.pyramid, *state.model, predictions(state), settings.track,
                             &photographs);
    }
    if (result.status == TrackingStatus::tracked) return result;
    if (const auto found = find_way_back(state, observed, frame.color, settings)) {
        return *found;
    }
    if (result.status == TrackingStatus::weak) return result;
    result.status = TrackingStatus::lost;
    result.world_from_camera = state.model->world_from_camera;
    if (result.why.empty()) result.why = "none of the earlier views explains it";
    if (const auto scale = other_scale(observed.pyramid.front(), *state.model))
        result.why += "; its depth is about " + std::to_string(std::lround(100 * *scale)) +
                      " % of what the model has there, and may be of another scale";
    return result;
}

TrackResult locate(const SlamState& state, const RgbdFrame& frame, const ObservedFrame& observed,
                   const SlamSettings& settings) {
    if (!state.model) return certain(frame.recorded_world_from_camera.value_or(Pose{}));
    if (state.volume.bricks.empty()) return certain(state.model->world_from_camera);
    return track(state, frame, observed, settings);
}

/// Whether a result may change the model.
bool trusted(const SlamState& state, const TrackResult& tracking) {
    if (tracking.status == TrackingStatus::tracked) return true;
    if (tracking.status == TrackingStatus::lost || !state.model) return false;
    const std::vector<Pose> expected = predictions(state);
    return std::any_of(expected.begin(), expected.end(), [&](const Pose& pose) {
        const Pose off = inverse(pose) * tracking.world_from_camera;
        return glm::length(off.translation) < expected_distance &&
               rotation_angle(Pose{}, off) < expected_angle;
    });
}

/// Goes on from a pose that is not trusted enough to change the model.
void follow(SlamState& state, const Pose& world_from_camera, const SlamSettings& settings) {
    state.before_last.reset();
    if (state.frames_lost == 0) state.before_last = state.model->world_from_camera;
    state.model =
        raycast_volume(state.volume, state.seen->lens, world_from_camera, settings.raycast);
    state.photograph = {};
    state.frames_lost = 0;
}

void learn(SlamState& state, const RgbdFrame& frame, ObservedFrame observed,
           const Pose& world_from_camera, const SlamSettings& settings) {
    state.before_last.reset();
    if (state.model && state.frames_lost == 0) state.before_last = state.model->world_from_camera;
    state.seen = std::move(observed.pyramid.front());
    state.seen->world_from_camera = world_from_camera;
    SeenColor color{frame.color, frame.lens, Pose{}};
    if (settings.follow_exposure)
        update_exposure(state.exposure, measure_exposure(state.volume, *state.seen, color));
    color.gain = state.exposure.measured;
    fuse_surface(state.volume, *state.seen, color, settings.fusion);
    state.photograph = frame.color;
    if (remember_view(state.keyframes, world_from_camera, observed.clean))
        state.keyframes.back().landmarks =
            find_landmarks(frame.color, observed.clean, state.seen->lens);
    state.model =
        raycast_volume(state.volume, state.seen->lens, world_from_camera, settings.raycast);
    state.frames_lost = 0;
}

}  // namespace

SlamState start_slam(const SlamSettings& settings) {
    validate(settings);
    SlamState state;
    state.volume = make_volume(settings.fusion);
    return state;
}

TrackResult track_and_fuse(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                           const std::optional<Pose>& known_world_from_camera) {
    ObservedFrame observed = observe_frame(frame, settings);
    TrackResult tracking = known_world_from_camera ? certain(*known_world_from_camera)
                                                   : locate(state, frame, observed, settings);
    state.fused = trusted(state, tracking);
    if (state.fused)
        learn(state, frame, std::move(observed), tracking.world_from_camera, settings);
    else if (tracking.status == TrackingStatus::weak)
        follow(state, tracking.world_from_camera, settings);
    else
        ++state.frames_lost;
    return tracking;
}

SlamStep advance_slam(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                      const std::optional<Pose>& known_world_from_camera) {
    SlamStep step{track_and_fuse(state, frame, settings, known_world_from_camera), {}};
    const bool at_full_size = state.model && state.model->lens.width == frame.lens.width;
    step.surface = state.fused && at_full_size
                       ? completed(*state.model, *state.seen, settings.raycast)
                       : see_model(state.volume, frame, step.tracking, settings);
    step.gain = state.exposure.gain;
    return step;
}

}  // namespace inlay
