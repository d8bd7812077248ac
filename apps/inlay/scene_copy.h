// A copy of a scene file with everything it refers to, so that a folder stands for itself.
#pragma once

#include "recordings/base/environment_map.h"

#include <filesystem>

namespace inlay {

/// Writes `target_folder`/scene.json: `scene_file` with its environment replaced by
/// truth/environment.exr of that folder, turned as `environment` is, and copies the meshes and
/// textures it names (with the files that those name) to the same relative places. The scene must
/// have been loaded before, so that its references are known to be good. Throws Error
/// (cannot_create, disk_fault).
void copy_scene(const std::filesystem::path& scene_file, const EnvironmentMap& environment,
                const std::filesystem::path& target_folder);

}  // namespace inlay
