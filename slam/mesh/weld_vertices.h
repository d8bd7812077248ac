// Triangle soup -> shared vertices.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace inlay {

struct WeldedTriangles {
    std::vector<glm::vec3> positions;  // voxels
    std::vector<glm::uvec3> triangles;
};

/// Merges the corners of a marching-cubes soup (three corners per triangle, in voxel units): those
/// on the same edge of the voxel lattice become one vertex, and those within 1e-4 voxels of a
/// lattice point become that point. Triangles that lose an edge by this are dropped.
WeldedTriangles weld_vertices(std::span<const glm::vec3> corners);

}  // namespace inlay
