#include "slam/mapping/advance_slam.h"

#include "slam/mapping/find_way_back.h"
#include "slam/mapping/observe_frame.h"
#include "slam/mapping/see_model.h"

#include <algorithm>
#include <string>

namespace inlay {
namespace {

TrackResult certain(const Pose& world_from_camera) {
    return {world_from_camera, TrackingStatus::tracked, 1, 0, 0, 1};
}

/// Where the camera may be now: gone on as before, or standing still.
std::vector<Pose> predictions(const SlamState& state) {
    const Pose& last = state.model->world_from_camera;
    if (!state.before_last) return {last};
    return {last * (inverse(*state.before_last) * last), last};
}

TrackResult track(const SlamState& state, const ObservedFrame& observed,
                  const SlamSettings& settings) {
    TrackResult result;
    if (state.frames_lost == 0) {
        result = track_frame(observed.pyramid, *state.model, predictions(state), settings.track);
    }
    if (result.status == TrackingStatus::tracked) return result;
    if (const auto found = find_way_back(state, observed.pyramid, observed.clean, settings)) {
        return *found;
    }
    if (result.status == TrackingStatus::weak) return result;
    result.status = TrackingStatus::lost;
    result.world_from_camera = state.model->world_from_camera;
    if (result.why.empty()) result.why = "none of the earlier views explains it";
    return result;
}

TrackResult locate(const SlamState& state, const RgbdFrame& frame, const ObservedFrame& observed,
                   const SlamSettings& settings) {
    if (!state.model) return certain(frame.recorded_world_from_camera.value_or(Pose{}));
    if (state.volume.bricks.empty()) return certain(state.model->world_from_camera);
    return track(state, observed, settings);
}

void learn(SlamState& state, const RgbdFrame& frame, ObservedFrame observed,
           const Pose& world_from_camera, const SlamSettings& settings) {
    state.before_last.reset();
    if (state.model && state.frames_lost == 0) state.before_last = state.model->world_from_camera;
    state.seen = std::move(observed.pyramid.front());
    state.seen->world_from_camera = world_from_camera;
    fuse_surface(state.volume, *state.seen, {frame.color, frame.lens, Pose{}}, settings.fusion);
    remember_view(state.keyframes, world_from_camera, observed.clean);
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
    if (tracking.status == TrackingStatus::lost) {
        ++state.frames_lost;
    } else {
        learn(state, frame, std::move(observed), tracking.world_from_camera, settings);
    }
    return tracking;
}

SlamStep advance_slam(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                      const std::optional<Pose>& known_world_from_camera) {
    SlamStep step{track_and_fuse(state, frame, settings, known_world_from_camera), {}};
    const bool lost = step.tracking.status == TrackingStatus::lost;
    const bool at_full_size = state.model && state.model->lens.width == frame.lens.width;
    step.surface = !lost && at_full_size ? completed(*state.model, *state.seen, settings.raycast)
                                         : see_model(state.volume, frame, step.tracking, settings);
    return step;
}

}  // namespace inlay
