#include "apps/inlay/scene_copy.h"

#include "composite/write/atomic_file.h"
#include "composite/write/file_content.h"
#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

#include <map>
#include <string>
#include <variant>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Json environment_json(const EnvironmentMap& environment) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rotation.push_back(environment.world_from_environment[column][row]);
    return {{"file", "truth/environment.exr"}, {"world_from_environment", rotation}};
}

bool is_environment(const AssetFile& asset, const SceneFile& scene) {
    const auto* file = std::get_if<fs::path>(&scene.environment.source);
    return file && *file == asset.file;
}

/// The source of each place in the copy.
std::map<fs::path, fs::path> places(const SceneFile& scene) {
    std::map<fs::path, fs::path> sources;
    for (const AssetFile& asset : scene.files) {
        if (is_environment(asset, scene)) continue;
        require(!asset.place.is_absolute() && *asset.place.begin() != "..",
                asset.file.string() +
                    ": is not referred to by a name beside or below what names it, so that a copy "
                    "of the scene could not find it; put it there",
                ExitCode::usage);
        const auto [place, fresh] = sources.emplace(asset.place, asset.file);
        require(fresh || place->second == asset.file,
                asset.file.string() + " and " + place->second.string() + " would both be " +
                    asset.place.string() + " in a copy of the scene; rename one of them",
                ExitCode::usage);
    }
    return sources;
}

}  // namespace

void copy_scene(const fs::path& scene_file, const SceneFile& scene,
                const EnvironmentMap& environment, const fs::path& target_folder) {
    for (const auto& [place, source] : places(scene)) {
        make_folder((target_folder / place).parent_path());
        write_text(target_folder / place, content_of(source));
    }
    Json copy = Json::parse(content_of(scene_file));
    copy["environment"] = environment_json(environment);
    write_text(target_folder / "scene.json", copy.dump(1) + "\n");
}

}  // namespace inlay
