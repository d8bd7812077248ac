#include "slam/depth/surface_from_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/depth/framed_depth.h"
#include "slam/depth/steep_surface.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace inlay {
namespace {

constexpr int reach = 2;             // px, over which slopes are measured
constexpr double off_centre = 0.75;  // px; fitted to one side of a rim, a plane leans with its bend

/// Eight pixels from `at` on, of a depth image with its rays.
struct Eight {
    const FramedDepth& depth;
    const Image<glm::vec3>& rays;
    glm::ivec2 at;

    /// The farthest neighbours within reach in a direction that are on the pixels' surfaces (m,
    /// camera frame); the pixels themselves where there are none.
    Vectors neighbours(const glm::ivec2& direction, const Floats& step) const {
        const Floats z = depth.eight(at.x, at.y);
        Floats z_farthest = z, steps = 0;
        Lanes joined(true);
        for (int i = 1; i <= reach; ++i) {
            const Floats next = depth.eight(at.x + i * direction.x, at.y + i * direction.y);
            joined = joined && next > 0 && stdx::abs(next - z) <= step;
            where(joined, z_farthest) = next;
            where(joined, steps) = float(i);
        }
        const auto far = numbers_of(steps);
        const Vectors ray = gathered([&](auto lane) -> const glm::vec3& {
            const glm::ivec2 pixel =
                at + glm::ivec2(int(lane), 0) + int(far[std::size_t(lane)]) * direction;
            return rays(std::min(pixel.x, rays.width - 1), pixel.y);
        });
        return {z_farthest * ray.x, z_farthest * ray.y, z_farthest * ray.z};
    }

    /// Cross products of the slopes along the rows and the columns.
    Vectors across(const DepthSettings& settings) const {
        const Floats step = depth_step(depth.eight(at.x, at.y), settings);
        const Vectors right = neighbours({1, 0}, step), left = neighbours({-1, 0}, step);
        const Vectors below = neighbours({0, 1}, step), above = neighbours({0, -1}, step);
        return cross({right.x - left.x, right.y - left.y, right.z - left.z},
                     {below.x - above.x, below.y - above.y, below.z - above.z});
    }
};

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
glm::vec3 normal_from(const glm::vec3& across, const glm::vec3& ray) {
    const float size = glm::length(across);
    if (!(size > 0 && std::isfinite(size))) return glm::vec3(0);
    return across * ((glm::dot(across, ray) > 0 ? -1.0f : 1.0f) / size);
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
    const FramedDepth surroundings = framed(depth, reach);
    parallel_rows(lens.height, [&](int y) {
        for (int first = 0; first < lens.width; first += lane_count) {
            const Vectors slopes = Eight{surroundings, *view.rays, {first, y}}.across(settings);
            for (int x = first; x < std::min(first + lane_count, lens.width); ++x) {
                const float z = depth(x, y);
                if (!std::isfinite(z) || z <= 0) continue;
                const auto lane = std::size_t(x - first);
                glm::vec3 across(slopes.x[lane], slopes.y[lane], slopes.z[lane]);
                if (across == glm::vec3(0))
                    across = across_steep(depth, *view.rays, {x, y}, settings);
                const glm::vec3 normal = normal_from(across, (*view.rays)(x, y));
                if (normal == glm::vec3(0)) continue;
                surface.position(x, y) = z * (*view.rays)(x, y);
                surface.normal(x, y) = normal;
                surface.confidence(x, y) = 1;
            }
        }
    });
    return surface;
}

}  // namespace inlay
