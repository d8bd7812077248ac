#include "slam/mapping/advance_slam.h"

#include "recordings/base/check.h"
#include "slam/depth/depth_pyramid.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/mapping/find_way_back.h"

#include <algorithm>
#include <string>

namespace inlay {
namespace {

/// One frame's geometry, as far as it can be trusted.
struct Observed {
    Image<float> clean;               // m
    std::vector<SurfaceMap> pyramid;  // of the smoothed depth, finest first
};

void require_sizes(const RgbdFrame& frame) {
    const auto fits = [&](int width, int height) {
        return width == frame.lens.width && height == frame.lens.height;
    };
    const bool color_fits = frame.color.empty() || fits(frame.color.width, frame.color.height);
    require(frame.lens.width > 0 && frame.lens.height > 0 && color_fits &&
                fits(frame.depth.width, frame.depth.height),
            "frame " + std::to_string(frame.index) +
                ": color, depth and lens must be of one size; depth has " +
                std::to_string(frame.depth.width) + " x " + std::to_string(frame.depth.height) +
                " px, the lens " + std::to_string(frame.lens.width) + " x " +
                std::to_string(frame.lens.height));
}

Observed observe(const RgbdFrame& frame, const SlamSettings& settings) {
    Observed observed;
    DepthLevel finest{clean_depth(frame.depth, settings.depth), frame.lens};
    if (settings.half_resolution) finest = halve(finest, settings.depth);
    observed.clean = std::move(finest.depth);
    for (const DepthLevel& level :
         depth_pyramid(smooth_depth(observed.clean, settings.depth), finest.lens,
                       settings.track.levels, settings.depth)) {
        observed.pyramid.push_back(
            surface_from_depth(level.depth, level.lens, Pose{}, settings.depth));
    }
    return observed;
}

TrackResult certain(const Pose& world_from_camera) {
    return {world_from_camera, TrackingStatus::tracked, 1, 0, 0, 1};
}

/// Where the camera may be now: gone on as before, or standing still.
std::vector<Pose> predictions(const SlamState& state) {
    const Pose& last = state.model->world_from_camera;
    if (!state.before_last) return {last};
    return {last * (inverse(*state.before_last) * last), last};
}

TrackResult track(const SlamState& state, const Observed& observed, const SlamSettings& settings) {
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
    return result;
}

TrackResult locate(const SlamState& state, const RgbdFrame& frame, const Observed& observed,
                   const SlamSettings& settings) {
    if (!state.model) return certain(frame.recorded_world_from_camera.value_or(Pose{}));
    if (state.volume.bricks.empty()) return certain(state.model->world_from_camera);
    return track(state, observed, settings);
}

/// The model's surface; where it has none, what the frame itself saw, as one observation.
SurfaceMap completed(SurfaceMap model, const SurfaceMap& own, const RaycastSettings& settings) {
    for (std::size_t i = 0; i < model.position.pixels.size(); ++i) {
        if (model.position.pixels[i].z > 0 || own.position.pixels[i].z <= 0) continue;
        model.position.pixels[i] = own.position.pixels[i];
        model.normal.pixels[i] = own.normal.pixels[i];
        model.confidence.pixels[i] = std::min(1.0f, 1.0f / settings.full_confidence);
    }
    return model;
}

SurfaceMap uncertain(SurfaceMap surface) {
    std::fill(surface.confidence.pixels.begin(), surface.confidence.pixels.end(), 0.0f);
    return surface;
}

void learn(SlamState& state, const RgbdFrame& frame, Observed observed,
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

bool same_size(const Lens& a, const Lens& b) { return a.width == b.width && a.height == b.height; }

/// What the frame itself saw, at full size.
SurfaceMap own_surface(const SlamState& state, const RgbdFrame& frame,
                       const SlamSettings& settings) {
    if (same_size(state.seen->lens, frame.lens)) return *state.seen;
    return surface_from_depth(filter_depth(frame.depth, settings.depth), frame.lens,
                              state.seen->world_from_camera, settings.depth);
}

}  // namespace

SlamSettings accurate_slam() { return {}; }

SlamSettings fast_slam() {
    SlamSettings settings;
    settings.half_resolution = true;
    settings.depth.smoothing_radius = 1;
    settings.fusion.voxel_size = 0.012f;
    settings.fusion.truncation = 0.048f;
    settings.track.iterations = 6;
    return settings;
}

void validate(const SlamSettings& settings) {
    validate(settings.depth);
    validate(settings.fusion);
    validate(settings.raycast);
    validate(settings.track);
}

SlamState start_slam(const SlamSettings& settings) {
    validate(settings);
    SlamState state;
    state.volume = make_volume(settings.fusion);
    return state;
}

TrackResult track_and_fuse(SlamState& state, const RgbdFrame& frame, const SlamSettings& settings,
                           const std::optional<Pose>& known_world_from_camera) {
    require_sizes(frame);
    Observed observed = observe(frame, settings);
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
    const Pose& pose = step.tracking.world_from_camera;
    const bool seen = state.model && same_size(state.model->lens, frame.lens) &&
                      step.tracking.status != TrackingStatus::lost;
    step.surface =
        seen ? *state.model : raycast_volume(state.volume, frame.lens, pose, settings.raycast);
    step.surface = step.tracking.status == TrackingStatus::lost
                       ? uncertain(std::move(step.surface))
                       : completed(std::move(step.surface), own_surface(state, frame, settings),
                                   settings.raycast);
    return step;
}

}  // namespace inlay
