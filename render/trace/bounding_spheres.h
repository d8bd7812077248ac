// BoundingSphere: few spheres that together hold all of a shape, for aiming rays at it.
#pragma once

#include "recordings/base/triangle_mesh.h"

#include <glm/glm.hpp>

#include <vector>

namespace inlay {

struct BoundingSphere {
    glm::vec3 centre{0.0f};  // m
    float radius = 0;        // m, >= 0
};

/// At most `most` (>= 1) spheres that hold every one of `parts`, chosen so that the sum of their
/// squared radii, and with it the solid angle they take from afar, is small: a compact shape gets
/// one, a table one for each leg. None for no parts.
std::vector<BoundingSphere> enclosing_spheres(std::vector<BoundingSphere> parts, int most);

/// The same for the triangles of a mesh that rays can meet: coordinates finite and below 1.8e18.
std::vector<BoundingSphere> enclosing_spheres(const TriangleMesh& mesh, int most);

}  // namespace inlay
