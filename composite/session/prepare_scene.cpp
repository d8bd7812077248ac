#include "composite/session/prepare_scene.h"

#include "composite/session/measure_up.h"
#include "composite/session/real_scene.h"
#include "recordings/base/check.h"
#include "render/scene/place_object.h"

#include <algorithm>
#include <functional>

namespace inlay {
namespace {

/// The model's surface as frame `number` sees it, after tracking from the recording's first frame.
SurfaceMap surface_of_frame(const Recording& recording, const Settings& settings, int number) {
    const std::vector<int>& frames = recording.info.frames;
    require(std::find(frames.begin(), frames.end(), number) != frames.end(),
            "scene: an object is placed in frame " + std::to_string(number) +
                ", which the recording does not have; its frames are " +
                std::to_string(frames.front()) + " to " + std::to_string(frames.back()));
    SlamState slam = start_slam(settings.slam);
    SlamStep step;
    for (const int frame : frames) {
        if (frame > number) break;
        step = track_frame_of(slam, recording.load(frame), settings);
    }
    require(step.tracking.status != TrackingStatus::lost,
            "scene: an object is placed in frame " + std::to_string(number) +
                ", but tracking is lost there; name another frame");
    return std::move(step.surface);
}

glm::dvec3 up_of(const RecordingInfo& info, const std::function<SurfaceMap(int)>& surface_of,
                 std::vector<std::string>& warnings) {
    if (info.up) return *info.up;
    const SurfaceMap first = surface_of(info.frames.front());
    if (const auto measured = measure_up(first)) {
        warnings.push_back(
            "the recording does not say where up is: measured from a plane of frame " +
            std::to_string(info.frames.front()));
        return *measured;
    }
    warnings.push_back(
        "the recording does not say where up is, and no plane tells: the first camera's is taken");
    return first.world_from_camera.rotation * glm::dvec3(0, -1, 0);
}

}  // namespace

std::string replaced_texels_text(const LoadedEnvironment& environment) {
    return "environment: " + std::to_string(environment.replaced_texels) +
           " texels were not finite or negative and are black now";
}

PreparedScene prepare_scene(const SceneFile& file, const Recording& recording,
                            const Settings& settings) {
    const auto surface_of = [&](int number) {
        return surface_of_frame(recording, settings, number);
    };
    PreparedScene prepared;
    prepared.warnings = file.warnings;
    prepared.up = up_of(recording.info, surface_of, prepared.warnings);
    prepared.scene = resolve_placements(file, surface_of, prepared.up);
    const RgbdFrame first = recording.load(recording.info.frames.front());
    const Pose anchor = first.recorded_world_from_camera.value_or(Pose{});
    LoadedEnvironment environment =
        load_environment(file.environment, prepared.up, anchor.rotation[2]);
    if (environment.replaced_texels > 0)
        prepared.warnings.push_back(replaced_texels_text(environment));
    prepared.environment = std::move(environment.map);
    return prepared;
}

}  // namespace inlay
