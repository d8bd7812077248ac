#include "composite/accuracy/work.h"

#include "composite/accuracy/work_fingerprint.h"
#include "composite/session/known_recording.h"
#include "recordings/base/check.h"
#include "recordings/environment/exr_image.h"
#include "render/filter/environment_bandwidth.h"
#include "render/scene/place_object.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;

fs::path truth_file(const Work& work, const char* kind, int frame, const char* end) {
    return work.source / "truth" / kind / fmt::format("{:06d}{}", frame, end);
}

void light(Work& work, EnvironmentMap map) {
    work.environment_bandwidth = environment_bandwidth(map.radiance);
    work.open_sky = make_environment_irradiance(map);
    work.environment = make_environment_sampler(std::move(map));
}

Work rendered_work(const fs::path& path) {
    const SceneFile file = load_scene_file(path);
    require(file.view.has_value(), path.string() + ": a scene without a recording needs a 'view'");
    Work work;
    work.source = path;
    work.view = file.view;
    work.warnings = file.warnings;
    work.scene_files = files_of(path, file);
    work.knows_room = true;
    const auto no_surface = [&](int) -> SurfaceMap {
        throw Error(ExitCode::bad_data,
                    path.string() + ": 'place' needs a recording; give the object a 'transform'");
    };
    work.scene = resolve_placements(file, no_surface, file.view->up);
    LoadedEnvironment environment = load_environment(file.environment, file.view->up, {0, 0, 1});
    if (environment.replaced_texels > 0) work.warnings.push_back(replaced_texels_text(environment));
    light(work, std::move(environment.map));
    return work;
}

/// How the recording was made, as far as its record.json says.
void describe_truth(Work& work) {
    const fs::path file = work.source / "record.json";
    std::ifstream stream(file);
    if (!stream) return;
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
    require(json.is_object(), file.string() + ": is no JSON; expected what `inlay record` writes");
    if (!work.truth_frames.empty()) work.truth_samples = json.value("truth_samples", 0);
    work.sensor_noise = json.value("sensor_noise", true);
}

bool any_real(const VirtualScene& scene) {
    for (const SceneObject& object : scene.objects)
        if (object.real) return true;
    return false;
}

Work recorded_work(const fs::path& path, const Settings& settings, const fs::path& scene_file) {
    Work work;
    work.source = path;
    work.recording = open_recording(path);
    const fs::path scene = scene_file.empty() ? path / "scene.json" : scene_file;
    require(fs::exists(scene),
            scene.string() + ": not there; name the recording's scene with --scene",
            ExitCode::input_missing);
    const SceneFile file = load_scene_file(scene);
    work.scene_files = files_of(scene, file);
    const auto known = know_recording(*work.recording, settings);
    PreparedScene prepared = prepare_scene(file, *work.recording, settings, known.get());
    work.scene = std::move(prepared.scene);
    work.warnings = std::move(prepared.warnings);
    work.knows_room = any_real(work.scene);
    light(work, std::move(prepared.environment));
    for (const int frame : work.recording->info.frames)
        if (fs::exists(truth_file(work, "composite", frame, ".exr")))
            work.truth_frames.push_back(frame);
    describe_truth(work);
    return work;
}

void require_size(const Image<Rgb>& image, const Lens& lens, const fs::path& file) {
    require(image.width == lens.width && image.height == lens.height,
            fmt::format("{}: {} x {} px, expected the recording's {} x {}; record truth and "
                        "frames with one size",
                        file.string(), image.width, image.height, lens.width, lens.height));
}

}  // namespace

Work open_work(const fs::path& path, const Settings& settings, const fs::path& scene_file) {
    require(fs::exists(path), path.string() + ": no such recording or scene",
            ExitCode::input_missing);
    const bool is_folder = fs::is_directory(path);
    Work work = is_folder ? recorded_work(path, settings, scene_file) : rendered_work(path);
    const fs::path trimmed = path.has_filename() ? path : path.parent_path();
    work.name = is_folder ? trimmed.filename().string() : path.stem().string();
    return work;
}

std::optional<Reference> truth_of_frame(const Work& work, int frame, const Lens& lens) {
    const fs::path file = truth_file(work, "composite", frame, ".exr");
    if (!work.recording || !fs::exists(file)) return std::nullopt;
    Image<Rgb> composite = read_exr(file);
    require_size(composite, lens, file);
    const fs::path error_file = truth_file(work, "composite", frame, ".stderr.exr");
    Image<Rgb> error = read_exr(error_file);
    require_size(error, lens, error_file);
    const fs::path recorded_file = truth_file(work, "recorded", frame, ".exr");
    const Image<Rgb> recorded = read_exr(recorded_file);
    require_size(recorded, lens, recorded_file);
    return make_reference(std::move(composite), std::move(error), recorded);
}

std::optional<Image<Rgb>> true_photograph(const Work& work, int frame) {
    const fs::path file = truth_file(work, "recorded", frame, ".exr");
    if (!work.recording || !fs::exists(file)) return std::nullopt;
    return read_exr(file);
}

Pose true_pose(const Work& work, int frame) {
    const RecordingInfo& info = work.recording->info;
    const auto found = std::find(info.frames.begin(), info.frames.end(), frame);
    require(found != info.frames.end(), work.name + ": there is no frame " + std::to_string(frame));
    const auto& pose = info.world_from_camera[std::size_t(found - info.frames.begin())];
    require(pose.has_value(),
            work.name + ": frame " + std::to_string(frame) + " has no recorded pose");
    return *pose;
}

}  // namespace inlay
