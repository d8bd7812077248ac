// A copy of a scene file with everything it refers to, so that a folder stands for itself.
#pragma once

#include "recordings/base/environment_map.h"
#include "render/scene/scene_file.h"

#include <filesystem>

namespace inlay {

/// Writes `target_folder`/scene.json: `scene_file`, which was loaded as `scene`, with its
/// environment replaced by truth/environment.exr of that folder, turned as `environment` is; and
/// copies exactly the other files that loading opened to the places where the copy finds them,
/// links as the files that they lead to. Throws Error: usage where two files would have one place
/// or one would lie outside the folder; cannot_create, disk_fault.
void copy_scene(const std::filesystem::path& scene_file, const SceneFile& scene,
                const EnvironmentMap& environment, const std::filesystem::path& target_folder);

}  // namespace inlay
