// Triangle soup -> shared vertices.
#pragma once

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace inlay {

/// A corner of a marching-cubes triangle: where it is, and on which edge of the voxel lattice. The
/// edge from voxel v to its neighbour along an axis a is named 2 v + a.
struct EdgeCorner {
    glm::ivec3 edge{0};
    glm::vec3 position{0};
};

struct WeldedTriangles {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;  // indices into positions
};

/// Makes one vertex of all corners on the same edge, at the position of the first, in the order of
/// first use. `soup` has three corners per triangle, and no triangle has two on one edge.
WeldedTriangles weld_vertices(std::span<const EdgeCorner> soup);

}  // namespace inlay
