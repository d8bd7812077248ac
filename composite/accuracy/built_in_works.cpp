#include "composite/accuracy/built_in_works.h"

#include "composite/accuracy/work_fingerprint.h"
#include "composite/record/film_scene.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

ordered_json description(const fs::path& scene, const SceneFile& file, const BuiltInSettings& s) {
    return {{"scene", scene.filename().string()},
            {"scene_fingerprint", fingerprint_of_scene(files_of(scene, file))},
            {"size", {s.size.x, s.size.y}},
            {"frames", s.frames},
            {"samples", s.samples},
            {"truth_frames", s.truth_frames},
            {"truth_samples", s.truth_samples}};
}

void record(const FilmedScene& film, const fs::path& folder, const BuiltInSettings& s,
            const RecordWatch& watch) {
    RecordSettings settings;
    settings.frames = s.frames;
    settings.samples = s.samples;
    settings.truth_samples = s.truth_samples;
    settings.truth_frames = {s.truth_frames.begin(), s.truth_frames.end()};
    const RecordResult recorded = record_scene(film, settings, folder, watch);
    require(recorded.finished == settings.frames,
            folder.string() + ": interrupted; the same command goes on from here",
            ExitCode::interrupted);
}

}  // namespace

const std::vector<std::string>& built_in_names() {
    static const std::vector<std::string> names{"desk", "sunny", "soft_sky", "contact", "moving"};
    return names;
}

Work built_in_work(const std::string& name, const fs::path& scenes, const fs::path& folder,
                   const BuiltInSettings& settings, const RecordWatch& watch) {
    const fs::path scene = scenes / (name + ".json");
    const fs::path recording = folder / name;
    const fs::path mark = recording / "record.json";
    const SceneFile file = load_scene_file(scene);
    const ordered_json wanted = description(scene, file, settings);
    if (!fs::exists(mark)) {
        make_folder(recording);
        record(film_scene(file, scene.string(), {settings.size, /*hand_held=*/true}), recording,
               settings, watch);
        write_text(mark, wanted.dump(1) + "\n");
    }
    std::ifstream stream(mark);
    require(ordered_json::parse(stream, nullptr, /*allow_exceptions=*/false) == wanted,
            mark.string() +
                ": was recorded with other settings, or the scene has changed since; choose "
                "another folder",
            ExitCode::usage);
    return open_work(recording, Settings{}, scene);
}

}  // namespace inlay
