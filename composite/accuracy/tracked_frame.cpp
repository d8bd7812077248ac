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

TrackedFrame kept(const RgbdFrame& frame, SlamStep step, const VoxelVolume& volume,
                  const TracedModel& model, const Settings& settings) {
    TrackedFrame result;
    result.frame = frame.index;
    result.time = frame.time;
    result.tracking = step.tracking;
    result.lens = step.surface.lens;
    result.world_from_camera = step.surface.world_from_camera;
    result.photo =
        std::make_shared<const Photo>(at_reference_exposure(linearise(frame.color, step.gain)));
    if (step.tracking.status == TrackingStatus::lost) return result;  // there is nothing to trace
    result.room = std::make_shared<const RealScene>(describe_real_scene(
        std::move(step.surface), result.photo->linear, volume, model, settings));
    result.geometry = result.room->geometry;
    result.depth_tolerance = settings.trace.depth_tolerance;
    return result;
}

void stand_in(const Work& work, TrackedFrame& frame) {
    frame.exact_room = std::make_shared<const EmbreeScene>(place_room(work, frame.time));
    frame.geometry = exact_real_geometry(*frame.exact_room, work.environment, first_path_dimension);
    frame.depth_tolerance = 0;
    frame.kept = nullptr;
}

/// The work's recording, with the sensor's depth or the true one.
Recording with_depth(const Work& work, SensorDepth depth) {
    Recording recording = *work.recording;
    if (depth == SensorDepth::recorded) return recording;
    recording.load = [&work](int number) {
        RgbdFrame frame = work.recording->load(number);
        const RecordingInfo& info = work.recording->info;
        const auto place = std::lower_bound(info.frames.begin(), info.frames.end(), number);
        const auto& pose = info.world_from_camera[std::size_t(place - info.frames.begin())];
        require(pose.has_value(), "exact depth needs a pose of every frame");
        frame.depth = trace_depth(place_room(work, frame.time), frame.lens, *pose);
        return frame;
    };
    return recording;
}

}  // namespace

std::vector<TrackedFrame> track_frames(const Work& work, const std::vector<int>& frames,
                                       const Settings& settings, SensorDepth depth) {
    const Recording seen = with_depth(work, depth);
    StopWatch watch;
    const auto known = depth == SensorDepth::recorded ? know_recording(seen, settings)
                                                      : reconstruct_afresh(seen, settings);
    const double known_ms = watch.lap() / double(seen.info.frames.size());
    SlamState slam = start_slam(settings.slam);
    TracedModel model;
    const bool keeps = known && settings.geometry.kind == RealGeometryKind::model;
    const auto kept_light = keeps ? std::make_shared<KeptLight>() : nullptr;
    std::vector<TrackedFrame> result;
    int count = 0;
    for (std::size_t i = 0; i < seen.info.frames.size() && result.size() < frames.size(); ++i) {
        const bool wanted =
            std::find(frames.begin(), frames.end(), seen.info.frames[i]) != frames.end();
        if (known && !wanted) continue;
        const RgbdFrame frame = seen.load(seen.info.frames[i]);
        watch.lap();
        SlamStep step =
            known ? known_frame_of(*known, frame, settings) : track_frame_of(slam, frame, settings);
        const VoxelVolume& volume = known ? known->volume : slam.volume;
        update_model(model, volume, known ? 0 : count++, settings.geometry);
        const double ms = watch.lap() + known_ms;
        if (!wanted) continue;
        result.push_back(kept(frame, std::move(step), volume, model, settings));
        result.back().slam_ms = ms;
        result.back().kept = kept_light;
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
