#include "composite/session/prepare_scene.h"

#include "composite/session/measure_up.h"
#include "composite/session/real_scene.h"
#include "recordings/base/check.h"
#include "render/scene/place_object.h"

#include <algorithm>
#include <optional>

namespace inlay {
namespace {

/// The model's surface as frame `number` sees it: the finished model's, or that of the frames up to
/// there.
SurfaceMap surface_of_frame(const Recording& recording, const Settings& settings,
                            const Reconstruction* known, int number) {
    const std::vector<int>& frames = recording.info.frames;
    require(std::find(frames.begin(), frames.end(), number) != frames.end(),
            "scene: an object is placed in frame " + std::to_string(number) +
                ", which the recording does not have; its frames are " +
                std::to_string(frames.front()) + " to " + std::to_string(frames.back()));
    SlamState slam = start_slam(settings.slam);
    SlamStep step;
    if (known) step = known_frame_of(*known, recording.load(number), settings);
    for (const int frame : frames) {
        if (known || frame > number) break;
        step = track_frame_of(slam, recording.load(frame), settings);
    }
    require(step.tracking.status != TrackingStatus::lost,
            "scene: an object is placed in frame " + std::to_string(number) +
                ", but no pose is known there; name another frame");
    return std::move(step.surface);
}

/// The first frame whose pose will be known; with recorded poses there may be none.
std::optional<int> anchor_frame(const RecordingInfo& info, const Settings& settings) {
    if (!settings.use_recorded_poses) return info.frames.front();
    for (std::size_t i = 0; i < info.frames.size(); ++i)
        if (info.world_from_camera[i]) return info.frames[i];
    return std::nullopt;
}

/// `first` is the view of the anchor frame, numbered `number`.
glm::dvec3 up_of(const SurfaceMap& first, int number, std::vector<std::string>& warnings) {
    const std::string unknown = "the recording does not say where up is";
    if (const auto measured = measure_up(first)) {
        warnings.push_back(unknown + ": measured from a plane of frame " + std::to_string(number));
        return *measured;
    }
    warnings.push_back(unknown + ", and no plane tells: the first camera's is taken");
    return first.world_from_camera.rotation * glm::dvec3(0, -1, 0);
}

}  // namespace

std::string replaced_texels_text(const LoadedEnvironment& environment) {
    return "environment: " + std::to_string(environment.replaced_texels) +
           " texels were not finite or negative and are black now";
}

PreparedScene prepare_scene(const SceneFile& file, const Recording& recording,
                            const Settings& settings, const Reconstruction* known) {
    const auto surface_of = [&](int number) {
        return surface_of_frame(recording, settings, known, number);
    };
    PreparedScene prepared;
    prepared.warnings = file.warnings;
    const std::optional<int> first = anchor_frame(recording.info, settings);
    Pose anchor;
    if (first) anchor = recording.load(*first).recorded_world_from_camera.value_or(Pose{});
    prepared.up = anchor.rotation * glm::dvec3(0, -1, 0);
    if (recording.info.up) {
        prepared.up = *recording.info.up;
    } else if (first) {
        prepared.up = up_of(surface_of(*first), *first, prepared.warnings);
    }
    prepared.scene = resolve_placements(file, surface_of, prepared.up);
    // A scene with a view of its own is lit as it was filmed, whatever the camera sees first.
    const glm::dvec3 forward = file.view ? glm::dvec3(0, 0, 1) : anchor.rotation[2];
    LoadedEnvironment environment = load_environment(file.environment, prepared.up, forward);
    if (environment.replaced_texels > 0)
        prepared.warnings.push_back(replaced_texels_text(environment));
    prepared.environment = std::move(environment.map);
    return prepared;
}

}  // namespace inlay
