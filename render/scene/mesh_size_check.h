// What a mesh file claims to hold, compared with its size before any memory is taken for it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace inlay {

/// The extension in lower case: ".obj", ".ply", ".gltf" or ".glb". Throws Error (bad_data) for any
/// other.
std::string mesh_extension(const std::filesystem::path& file);

/// Throws Error (bad_data) where a .ply header claims more elements, or a .gltf or .glb more
/// accessor elements, than a file of this size, its buffers included, can hold. Other kinds pass.
void require_plausible_counts(const std::filesystem::path& file);

/// The triangles that the meshes of a .gltf or .glb list, each mesh once; 0 for other kinds.
std::size_t listed_triangles(const std::filesystem::path& file);

}  // namespace inlay
