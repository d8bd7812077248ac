// A mesh as a binary PLY file.
#pragma once

#include "recordings/base/triangle_mesh.h"

#include <filesystem>

namespace inlay {

/// Writes positions, and normals and colors (as sRGB bytes) where the mesh has them. The file
/// appears under its name only when it is complete. Throws Error with ExitCode::cannot_create or
/// ExitCode::disk_fault.
void write_ply(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace inlay
