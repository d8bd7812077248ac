// The part of mesh reading that talks to assimp: which importers, which files, which materials.
// For the sources of this folder only.
#pragma once

#include "render/scene/mesh_files.h"

#include <memory>

namespace Assimp {
class Importer;
}

namespace inlay {

/// A file as assimp read it; the importer owns the scene.
struct MeshImport {
    std::shared_ptr<Assimp::Importer> importer;
    std::filesystem::path file;
    AssetFolders assets;
};

/// Reads a file with the OBJ, PLY and glTF 2.0 importers alone, through files that cannot leave
/// `assets`. Throws Error as load_mesh.
MeshImport import_mesh(const std::filesystem::path& file, const AssetFolders& assets,
                       MeshMaterials materials);

/// The material of that index, its textures loaded; empty where the file defines none.
std::optional<Material> own_material(const MeshImport& import, unsigned index,
                                     std::vector<std::string>& warnings);

}  // namespace inlay
