// Readers of the parts of a scene description. For the sources of this folder only.
#pragma once

#include "render/scene/asset_folders.h"
#include "render/scene/json_node.h"
#include "render/scene/scene_file.h"

namespace inlay {

constexpr Range any_length{-1e6, 1e6};  // m
constexpr Range any_time{-1e9, 1e9};    // s
constexpr Range any_radiance{0, 1e6};   // relative
constexpr Range share{0, 1};

glm::dvec3 vector3_of(const JsonNode& node, const Range& range);
Rgb color_of(const JsonNode& node, const Range& range);
glm::dvec3 direction_of(const JsonNode& node);  // three numbers, not all 0; returned unit
glm::dmat3 rotation_of(const JsonNode& node);   // 9 numbers, row-major; made orthonormal
Pose pose_of(const JsonNode& node);             // 16 numbers, row-major, rigid
glm::dmat4 transform_of(const JsonNode& node);  // 16 numbers, row-major; scale, no shear or mirror

EnvironmentSpec environment_of(const JsonNode& node, const AssetFolders& assets);
/// Lights, medium and camera of a description. Throws where they are not well formed.
SceneRequests requests_of(const JsonNode& document, const AssetFolders& assets);
/// Throws Error (bad_data) that names the first thing of `asked` that cannot be simulated.
void refuse_what_cannot_be_done(const JsonNode& document, const SceneRequests& asked);
Material material_of(const JsonNode& node, const AssetFolders& assets);
bool textured(const Material& material);
SceneEntry entry_of(const JsonNode& node, const AssetFolders& assets,
                    std::vector<std::string>& warnings);

/// Throws unless the times of `items`, each with a "time", increase strictly.
void require_increasing_times(const std::vector<JsonNode>& items);

}  // namespace inlay
