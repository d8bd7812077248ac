// ObjectBounds: a box and a sphere that hold an object, in the object's own frame.
#pragma once

#include "render/scene/virtual_scene.h"

#include <glm/glm.hpp>

#include <limits>
#include <vector>

namespace inlay {

/// Both hold every point of the object; the sphere stands about the box's middle.
struct ObjectBounds {
    glm::dvec3 least{std::numeric_limits<double>::infinity()};      // m
    glm::dvec3 greatest{-std::numeric_limits<double>::infinity()};  // m
    double radius = 0;                                              // m

    bool empty() const { return !(least.x <= greatest.x); }  // the object has no surface
    glm::dvec3 middle() const { return 0.5 * (least + greatest); }
};

/// Of all parts, from the vertices that triangles use.
ObjectBounds bounds_of(const SceneObject& object);

/// One for each object of the scene, in its order.
std::vector<ObjectBounds> bounds_of(const VirtualScene& scene);

}  // namespace inlay
