// A binary tree over the parts, halved at medians, and the cheapest cut through it.
#include "render/trace/bounding_spheres.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>

namespace inlay {
namespace {

using Spheres = std::vector<BoundingSphere>;

/// What rounding may take from a radius, so that the spheres hold their parts in any case.
constexpr float rounding_margin = 1 + 1e-5f;

struct Box {
    glm::vec3 low, high;
};

Box box_of(std::span<const BoundingSphere> parts) {
    Box box{parts[0].centre - parts[0].radius, parts[0].centre + parts[0].radius};
    for (const BoundingSphere& part : parts) {
        box.low = glm::min(box.low, part.centre - part.radius);
        box.high = glm::max(box.high, part.centre + part.radius);
    }
    return box;
}

BoundingSphere around(std::span<const BoundingSphere> parts) {
    if (parts.size() == 1) return parts[0];
    const Box box = box_of(parts);
    BoundingSphere sphere{0.5f * (box.low + box.high), 0};
    for (const BoundingSphere& part : parts)
        sphere.radius =
            std::max(sphere.radius, glm::distance(sphere.centre, part.centre) + part.radius);
    sphere.radius *= rounding_margin;
    return sphere;
}

int longest_axis(const Box& box) {
    const glm::vec3 size = box.high - box.low;
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

float cost(const Spheres& spheres) {
    float sum = 0;
    for (const BoundingSphere& sphere : spheres)
        sum += sphere.radius * sphere.radius;
    return sum;
}

/// The better of one sphere around all, and the best of both halves.
Spheres best_cut(std::span<BoundingSphere> parts, int most) {
    Spheres whole{around(parts)};
    if (most < 2 || parts.size() < 2) return whole;
    const int axis = longest_axis(box_of(parts));
    const auto middle = parts.begin() + std::ptrdiff_t(parts.size() / 2);
    std::nth_element(parts.begin(), middle, parts.end(),
                     [axis](const BoundingSphere& a, const BoundingSphere& b) {
                         return a.centre[axis] < b.centre[axis];
                     });
    const auto half = std::size_t(middle - parts.begin());
    Spheres split = best_cut(parts.first(half), most / 2);
    const Spheres rest = best_cut(parts.subspan(half), most - most / 2);
    split.insert(split.end(), rest.begin(), rest.end());
    return cost(split) < cost(whole) ? split : whole;
}

/// Rays meet no triangle with coordinates that are not finite or beyond Embree's largest.
bool can_be_met(const TriangleMesh& mesh, const glm::uvec3& t) {
    constexpr float largest = 1.844e18f;
    for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            if (!(std::abs(mesh.positions[t[corner]][axis]) < largest)) return false;
    return true;
}

BoundingSphere around_triangle(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
    const glm::vec3 centre = 0.5f * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c)));
    const float radius =
        std::max({glm::distance(centre, a), glm::distance(centre, b), glm::distance(centre, c)});
    return {centre, radius * rounding_margin};
}

}  // namespace

Spheres enclosing_spheres(Spheres parts, int most) {
    return parts.empty() ? Spheres{} : best_cut(parts, most);
}

Spheres enclosing_spheres(const TriangleMesh& mesh, int most) {
    Spheres parts;
    parts.reserve(mesh.triangles.size());
    for (const glm::uvec3& triangle : mesh.triangles)
        if (can_be_met(mesh, triangle)) parts.push_back(around_triangle(mesh, triangle));
    return enclosing_spheres(std::move(parts), most);
}

}  // namespace inlay
