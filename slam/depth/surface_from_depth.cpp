#include "slam/depth/surface_from_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/depth/steep_surface.h"

#include <cmath>
#include <string>

namespace inlay {
namespace {

constexpr int reach = 2;             // px, over which slopes are measured
constexpr double off_centre = 0.75;  // px; fitted to one side of a rim, a plane leans with its bend

/// The farthest neighbour within reach, in the direction (dx, dy), that is on the pixel's surface;
/// the pixel itself where there is none.
glm::ivec2 neighbour(const Image<float>& depth, const glm::ivec2& at, const glm::ivec2& direction,
                     float step) {
    const float z = depth(at.x, at.y);
    glm::ivec2 farthest = at;
    for (int i = 1; i <= reach; ++i) {
        const glm::ivec2 next = at + i * direction;
        if (!depth.contains(next.x, next.y)) break;
        const float z_next = depth(next.x, next.y);
        if (!std::isfinite(z_next) || z_next <= 0 || std::abs(z_next - z) > step) break;
        farthest = next;
    }
    return farthest;
}

/// The cross product of the slopes of the plane that a steep surface's pixel lies on; 0 if none.
glm::vec3 across_steep(const Image<float>& depth, const Image<glm::vec3>& rays,
                       const glm::ivec2& at, const DepthSettings& settings) {
    const bool inside = depth.contains(at.x - 1, at.y - 1) && depth.contains(at.x + 1, at.y + 1);
    const auto plane = inside ? steep_plane(depth, at, settings) : std::nullopt;
    if (!plane || glm::length(plane->centre) > off_centre) return glm::vec3(0);
    const auto point = [&](int dx, int dy) {
        return float(plane->depth_at(dx, dy)) * rays(at.x + dx, at.y + dy);
    };
    return glm::cross(point(1, 0) - point(-1, 0), point(0, 1) - point(0, -1));
}

/// Unit normal towards the camera; 0 where the surface is too small to have one.
glm::vec3 normal_at(const Image<float>& depth, const Image<glm::vec3>& rays, const glm::ivec2& at,
                    const DepthSettings& settings) {
    const float step = depth_step(depth(at.x, at.y), settings);
    const auto slope = [&](const glm::ivec2& direction) {
        const glm::ivec2 a = neighbour(depth, at, direction, step);
        const glm::ivec2 b = neighbour(depth, at, -direction, step);
        return depth(a.x, a.y) * rays(a.x, a.y) - depth(b.x, b.y) * rays(b.x, b.y);
    };
    glm::vec3 across = glm::cross(slope({1, 0}), slope({0, 1}));
    if (across == glm::vec3(0)) across = across_steep(depth, rays, at, settings);
    const float size = glm::length(across);
    if (!(size > 0 && std::isfinite(size))) return glm::vec3(0);
    const bool away = glm::dot(across, rays(at.x, at.y)) > 0;
    return across * ((away ? -1.0f : 1.0f) / size);
}

}  // namespace

SurfaceMap surface_from_depth(const Image<float>& depth, const Lens& lens,
                              const Pose& world_from_camera, const DepthSettings& settings) {
    require(depth.width == lens.width && depth.height == lens.height,
            "depth is " + std::to_string(depth.width) + " x " + std::to_string(depth.height) +
                " px, its lens says " + std::to_string(lens.width) + " x " +
                std::to_string(lens.height));
    SurfaceMap surface = empty_surface_map(lens, world_from_camera);
    const CameraView view = camera_view(lens);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            if (!std::isfinite(depth(x, y)) || depth(x, y) <= 0) continue;
            const glm::vec3 normal = normal_at(depth, *view.rays, {x, y}, settings);
            if (normal == glm::vec3(0)) continue;
            surface.position(x, y) = depth(x, y) * (*view.rays)(x, y);
            surface.normal(x, y) = normal;
            surface.confidence(x, y) = 1;
        }
    });
    return surface;
}

}  // namespace inlay
