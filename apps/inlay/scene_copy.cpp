#include "apps/inlay/scene_copy.h"

#include "composite/write/atomic_file.h"

#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <set>
#include <span>
#include <string>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string content_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

bool names_other_files(const fs::path& file) {
    const std::string extension = file.extension().string();
    return extension == ".obj" || extension == ".mtl" || extension == ".gltf";
}

/// Copies a file, and those of its folder whose names occur in it, and so on.
void copy_with_references(const fs::path& from_folder, const fs::path& name,
                          const fs::path& to_folder, std::set<fs::path>& copied) {
    if (!copied.insert(name).second) return;
    const std::string content = content_of(from_folder / name);
    make_folder((to_folder / name).parent_path());
    write_file(to_folder / name, std::as_bytes(std::span(content)));
    if (!names_other_files(name)) return;
    for (const auto& entry : fs::directory_iterator((from_folder / name).parent_path())) {
        const fs::path other = entry.path().filename();
        if (entry.is_regular_file() && content.find(other.string()) != std::string::npos)
            copy_with_references(from_folder, name.parent_path() / other, to_folder, copied);
    }
}

Json environment_json(const EnvironmentMap& environment) {
    Json rotation = Json::array();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            rotation.push_back(environment.world_from_environment[column][row]);
    return {{"file", "truth/environment.exr"}, {"world_from_environment", rotation}};
}

}  // namespace

void copy_scene(const fs::path& scene_file, const EnvironmentMap& environment,
                const fs::path& target_folder) {
    const fs::path folder = scene_file.parent_path();
    Json scene = Json::parse(content_of(scene_file));
    scene["environment"] = environment_json(environment);
    std::set<fs::path> copied;
    for (const Json& object : scene["objects"]) {
        const auto copy = [&](const std::string& name) {
            if (fs::exists(folder / name))
                copy_with_references(folder, name, target_folder, copied);
        };
        if (object.contains("mesh")) copy(object["mesh"]);
        if (object.contains("material") && object["material"].contains("texture"))
            copy(object["material"]["texture"]);
    }
    const std::string text = scene.dump(1) + "\n";
    write_file(target_folder / "scene.json", std::as_bytes(std::span(text)));
}

}  // namespace inlay
