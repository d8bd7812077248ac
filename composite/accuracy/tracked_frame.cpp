#include "composite/accuracy/tracked_frame.h"

#include "composite/session/stop_watch.h"
#include "recordings/base/check.h"
#include "render/trace/picture.h"
#include "render/trace/sample_pass.h"

#include <algorithm>
#include <utility>

namespace inlay {
namespace {

EmbreeScene place_room(const Work& work, double time) {
    require(work.knows_room, work.source.string() +
                                 ": its scene has no real objects, so the true room is unknown; "
                                 "use a recording made by `inlay record`");
    return EmbreeSceneCache().place(work.scene, time, /*real=*/true);
}

TrackedFrame kept(const RgbdFrame& frame, SlamStep step, const SlamState& slam,
                  const TracedModel& model, const Settings& settings) {
    TrackedFrame result;
    result.frame = frame.index;
    result.time = frame.time;
    result.tracking = step.tracking;
    result.lens = frame.lens;
    result.world_from_camera = step.surface.world_from_camera;
    result.photo = std::make_shared<const Photo>(linearise(frame.color));
    if (step.tracking.status == TrackingStatus::lost) return result;  // there is nothing to trace
    result.room = std::make_shared<const RealScene>(
        describe_real_scene(std::move(step.surface), result.photo->linear, slam, model, settings));
    result.geometry = result.room->geometry;
    result.depth_tolerance = settings.trace.depth_tolerance;
    return result;
}

void stand_in(const Work& work, TrackedFrame& frame) {
    frame.exact_room = std::make_shared<const EmbreeScene>(place_room(work, frame.time));
    frame.geometry = exact_real_geometry(*frame.exact_room, work.environment, first_path_dimension);
    frame.depth_tolerance = 0;
}

}  // namespace

std::vector<TrackedFrame> track_frames(const Work& work, const std::vector<int>& frames,
                                       const Settings& settings, SensorDepth depth) {
    SlamState slam = start_slam(settings.slam);
    TracedModel model;
    std::vector<TrackedFrame> result;
    int seen = 0;
    const RecordingInfo& info = work.recording->info;
    for (std::size_t i = 0; i < info.frames.size() && result.size() < frames.size(); ++i) {
        RgbdFrame frame = work.recording->load(info.frames[i]);
        if (depth == SensorDepth::exact) {
            require(info.world_from_camera[i].has_value(),
                    "exact depth needs a pose of every frame");
            frame.depth =
                trace_depth(place_room(work, frame.time), frame.lens, *info.world_from_camera[i]);
        }
        StopWatch watch;
        SlamStep step = track_frame_of(slam, frame, settings);
        update_model(model, slam, seen++, settings.geometry);
        const double ms = watch.lap();
        if (std::find(frames.begin(), frames.end(), frame.index) == frames.end()) continue;
        result.push_back(kept(frame, std::move(step), slam, model, settings));
        result.back().slam_ms = ms;
    }
    return result;
}

TrackedFrame with_true_room(const Work& work, const TrackedFrame& frame,
                            const Pose& world_from_camera) {
    TrackedFrame result = frame;
    result.world_from_camera = world_from_camera;
    stand_in(work, result);
    return result;
}

TrackedFrame photograph_view(const Work& work, std::uint32_t seed, int photo_samples) {
    TrackedFrame result;
    result.lens = work.view->lens;
    result.world_from_camera = work.view->world_from_camera;
    stand_in(work, result);
    Image<Rgb> picture =
        trace_picture(*result.exact_room, work.environment,
                      {result.lens, result.world_from_camera, seed, 0}, photo_samples)
            .radiance;
    result.photo = std::make_shared<const Photo>(Photo{encode(picture), std::move(picture)});
    return result;
}

}  // namespace inlay
