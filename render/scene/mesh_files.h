// Meshes with their own materials from OBJ, PLY and glTF 2.0 files.
#pragma once

#include "recordings/base/triangle_mesh.h"
#include "render/scene/asset_folders.h"
#include "render/scene/material.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace inlay {

struct LoadedPart {
    TriangleMesh mesh;                 // file units; normals present, texture origin top-left
    std::optional<Material> material;  // the file's own
};

/// Whether a file's own materials are wanted; if not, missing textures are no error.
enum class MeshMaterials { read, ignore };

struct LoadedMesh {
    std::vector<LoadedPart> parts;      // at least one, none empty
    int dropped_triangles = 0;          // without area
    std::vector<std::string> warnings;  // what was left out, for the user
};

/// Reads a .obj, .ply, .gltf or .glb file, node transforms applied. Polygons are cut into
/// triangles, triangles without area dropped, missing normals made smooth (area-weighted). An OBJ's
/// Kd and map_Kd become Diffuse, so do a PLY's vertex colors (sRGB); a glTF's material Ggx; of a
/// metallic-roughness texture the mean is used. Whatever the file refers to must lie in `assets`.
/// Throws Error: input_missing; bad_data for damaged files, indices out of range, values that are
/// not finite, sizes that the file cannot hold, more than 20 million triangles, and references that
/// leave the folders.
LoadedMesh load_mesh(const std::filesystem::path& file, const AssetFolders& assets,
                     MeshMaterials materials = MeshMaterials::read);

}  // namespace inlay
