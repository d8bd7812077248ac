#include "composite/plan/object_bounds.h"

#include <algorithm>

namespace inlay {
namespace {

/// Calls `visit(centre, radius)` for balls that together hold the part: its vertices, or itself.
template <class Visit>
void for_each_ball(const ObjectPart& part, const Visit& visit) {
    if (const auto* sphere = std::get_if<SphereShape>(&part.shape)) {
        visit(glm::dvec3(0), double(sphere->radius));
        return;
    }
    const TriangleMesh& mesh = *std::get<MeshShape>(part.shape).mesh;
    for (const glm::uvec3& triangle : mesh.triangles)
        for (int corner = 0; corner < 3; ++corner)
            visit(glm::dvec3(mesh.positions[triangle[corner]]), 0.0);
}

}  // namespace

ObjectBounds bounds_of(const SceneObject& object) {
    ObjectBounds bounds;
    for (const ObjectPart& part : object.parts)
        for_each_ball(part, [&](const glm::dvec3& centre, double radius) {
            bounds.least = glm::min(bounds.least, centre - radius);
            bounds.greatest = glm::max(bounds.greatest, centre + radius);
        });
    if (bounds.empty()) return bounds;
    for (const ObjectPart& part : object.parts)
        for_each_ball(part, [&](const glm::dvec3& centre, double radius) {
            bounds.radius =
                std::max(bounds.radius, glm::distance(centre, bounds.middle()) + radius);
        });
    return bounds;
}

std::vector<ObjectBounds> bounds_of(const VirtualScene& scene) {
    std::vector<ObjectBounds> all;
    for (const SceneObject& object : scene.objects)
        all.push_back(bounds_of(object));
    return all;
}

}  // namespace inlay
