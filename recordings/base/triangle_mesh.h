// TriangleMesh: indexed triangles with optional per-vertex attributes.
#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace inlay {

/// Optional attributes are empty or as long as `positions`. Triangles wind counter-clockwise seen
/// from the side their normal points to.
struct TriangleMesh {
    std::vector<glm::vec3> positions;            // m
    std::vector<glm::vec3> normals;              // unit; optional
    std::vector<glm::vec2> texture_coordinates;  // (0, 0) = top-left of the texture; optional
    std::vector<glm::vec3> colors;               // linear radiance or reflectance; optional
    std::vector<glm::uvec3> triangles;           // indices into positions
};

}  // namespace inlay
