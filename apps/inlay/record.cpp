// `inlay record`: a synthetic recording whose truth is known.
#include "composite/record/film_scene.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"
#include "render/scene/scene_file.h"

#include "apps/inlay/command.h"
#include "apps/inlay/frame_list.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/options.h"
#include "apps/inlay/progress.h"
#include "apps/inlay/render_options.h"
#include "apps/inlay/scene_copy.h"
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace inlay {
namespace {

namespace fs = std::filesystem;

struct RecordOptions {
    CommonOptions common;
    std::string scene, out;
    RecordSettings record;
    std::string size;         // "WxH"; "" = the scene's
    std::string truth = "0";  // frames with truth
    bool no_noise = false, still = false;
    std::vector<std::string> assets;
};

/// A scene file, or the name of one of the project's own scenes.
fs::path scene_path(const std::string& name) {
    if (fs::path(name).extension() == ".json") return name;
    const fs::path own = fs::path(INLAY_SCENES_DIR) / (name + ".json");
    require(fs::exists(own),
            "record " + name +
                ": neither a scene file (.json) nor one of the project's own scenes; "
                "try `inlay record desk`",
            ExitCode::input_missing);
    return own;
}

/// None for "", which stands for the scene's own size.
std::optional<glm::ivec2> size_of(const std::string& size) {
    if (size.empty()) return std::nullopt;
    int width = 0, height = 0, read = 0;
    const int fields = std::sscanf(size.c_str(), "%dx%d%n", &width, &height, &read);
    require(fields == 2 && read == int(size.size()) && width > 0 && height > 0 && width <= 8192 &&
                height <= 8192,
            "--size " + size + ": expected WIDTHxHEIGHT in px, as in 640x480", ExitCode::usage);
    return glm::ivec2(width, height);
}

std::set<int> frames_of(const std::string& list, int frames) {
    std::set<int> result;
    if (list == "none") return result;
    const FrameList parsed = parse_frames(list);
    for (int i = 0; i < frames; ++i)
        if (parsed.contains(i)) result.insert(i);
    require(!result.empty(),
            "record: none of the frames " + list + " is in 0-" + std::to_string(frames - 1),
            ExitCode::usage);
    return result;
}

void write_record_json(const fs::path& folder, const RecordOptions& o) {
    const RecordSettings& r = o.record;
    const nlohmann::ordered_json json{{"version", INLAY_VERSION},
                                      {"scene", fs::path(o.scene).filename().string()},
                                      {"frames", r.frames},
                                      {"frames_per_second", r.frames_per_second},
                                      {"samples", r.samples},
                                      {"truth_frames", r.truth_frames},
                                      {"truth_samples", r.truth_samples},
                                      {"sensor_noise", r.sensor_noise},
                                      {"hand_held", !o.still},
                                      {"seed", r.seed}};
    write_text(folder / "record.json", json.dump(2) + "\n");
}

/// Says so where not all of the wanted frames were finished.
RecordResult record_frames(const FilmedScene& film, const RecordOptions& o, int wanted) {
    catch_interrupts();
    RecordResult result;
    {
        Progress progress("frames", wanted, o.common.quiet);
        result = record_scene(film, o.record, o.out,
                              {[&](int done) { progress.advance_to(done); }, interrupted});
    }
    if (result.finished < wanted)
        spdlog::warn(
            "interrupted: {} of {} frames are finished and stay in {}, which is incomplete (it has "
            "no record.json); run the same command again to make it whole",
            result.finished, wanted, o.out);
    return result;
}

void print_result(const RecordOptions& o, const RecordResult& result) {
    if (o.common.json) {
        const nlohmann::ordered_json json{{"out", o.out},
                                          {"frames", result.finished},
                                          {"dropped_samples", result.dropped_samples}};
        std::cout << json.dump(2) << "\n";
        return;
    }
    warn_of_non_finite(result.dropped_samples, 0);
}

int run(RecordOptions& o) {
    apply(o.common);
    const fs::path file = scene_path(o.scene);
    const SceneFile scene = load_scene_file(file, {o.assets.begin(), o.assets.end()});
    for (const std::string& warning : scene.warnings)
        spdlog::warn("{}", warning);
    const FilmedScene film = film_scene(scene, file.string(), {size_of(o.size), !o.still});
    for (const std::string& warning : film.warnings)
        spdlog::warn("{}", warning);
    o.record.seed = o.common.seed;
    o.record.sensor_noise = !o.no_noise;
    o.record.truth_frames = frames_of(o.truth, o.record.frames);
    if (o.common.frames != "all")
        o.record.written_frames = frames_of(o.common.frames, o.record.frames);
    const fs::path folder = o.out;
    require(!fs::exists(folder / "record.json"),
            folder.string() + ": holds a recording already; choose another --out",
            ExitCode::cannot_create);
    make_folder(folder);
    copy_scene(file, scene, film.environment, folder);
    const int wanted = wanted_frames(o.record);
    const RecordResult result = record_frames(film, o, wanted);
    if (result.finished < wanted) return int(ExitCode::interrupted);
    if (o.record.written_frames.empty()) write_record_json(folder, o);
    print_result(o, result);
    return 0;
}

}  // namespace

std::function<int()> add_record(CLI::App& subcommand) {
    const auto o = std::make_shared<RecordOptions>();
    subcommand.add_option("ROOM", o->scene, "a scene file with 'view' and 'path', or desk")
        ->required();
    subcommand.add_option("--out", o->out, "the folder to write")->required();
    subcommand.add_option("--length", o->record.frames, "frames to record")->capture_default_str();
    subcommand.add_option("--rate", o->record.frames_per_second, "frames per second")
        ->capture_default_str();
    subcommand.add_option("--size", o->size, "WIDTHxHEIGHT in px (default: the scene's)");
    subcommand.add_option("--samples", o->record.samples, "paths per pixel of the recorded color")
        ->capture_default_str();
    subcommand.add_option("--truth", o->truth, "frames with truth, as 0-29x10; or all, none")
        ->capture_default_str();
    subcommand
        .add_option("--truth-samples", o->record.truth_samples, "paths per pixel of the truth")
        ->capture_default_str();
    subcommand.add_flag("--no-noise", o->no_noise, "exact depth instead of a sensor's");
    subcommand.add_flag("--still", o->still, "no hand shake");
    subcommand.add_option("--assets", o->assets, "folder with files of the scene")
        ->allow_extra_args(false);
    add_common_options(subcommand, o->common);
    return [o] { return run(*o); };
}

}  // namespace inlay
