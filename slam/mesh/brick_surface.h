// Marching cubes over the cells of one brick.
#pragma once

#include "slam/volume/voxel_volume.h"

#include <glm/glm.hpp>

#include <vector>

namespace inlay {

/// Where the surface crosses an edge of the voxel lattice. The edge from voxel v to its neighbor
/// along an axis a is named 2 v + a.
struct EdgeVertex {
    glm::ivec3 edge{0};
    glm::vec3 position{0};  // voxels
    glm::vec3 normal{0};    // the field's gradient per voxel; 0 where it is not known
    glm::vec3 color{0};
};

/// No two vertices lie on one edge; they are in the order of first use.
struct BrickSurface {
    std::vector<EdgeVertex> vertices;
    std::vector<glm::uvec3> triangles;  // indices into vertices
};

/// The surface in the cells that begin in the brick.
BrickSurface brick_surface(const VoxelVolume& volume, const Brick& brick);

}  // namespace inlay
