// The model as triangles.
#pragma once

#include "recordings/base/triangle_mesh.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

/// The zero surface of the volume (world frame, m), by marching cubes over every cell whose eight
/// voxels were all seen; vertices are shared, with the field's gradient as normals and the fused
/// linear colors. Triangles wind counter-clockwise seen from the free side. Lorensen and Cline
/// 1987. Same bytes for any number of threads.
TriangleMesh extract_mesh(const VoxelVolume& volume);

}  // namespace inlay
