// Closed-form rooms for tests of the screen tracer: what a camera sees of them, and what a ray
// meets.
#pragma once

#include "recordings/base/random.h"
#include "recordings/base/surface_map.h"
#include "render/sample/warp.h"
#include "render/trace/image_ray.h"

#include <glm/glm.hpp>

#include <cmath>
#include <limits>
#include <vector>

namespace inlay::test {

struct SolidHit {
    double distance = std::numeric_limits<double>::infinity();  // m
    glm::dvec3 normal{0.0};                                     // unit, outward
};

struct SolidPlane {
    glm::dvec3 normal;  // unit; the solid lies behind it
    double offset;      // m: normal . x = offset
};
struct SolidSphere {
    glm::dvec3 centre;  // m
    double radius;      // m
};
struct SolidBox {
    glm::dvec3 low, high;  // m
};

/// In camera coordinates.
struct Room {
    std::vector<SolidPlane> planes;
    std::vector<SolidSphere> spheres;
    std::vector<SolidBox> boxes;
};

inline void keep_nearer(SolidHit& best, double t, const glm::dvec3& normal) {
    if (t > 0 && t < best.distance) best = {t, normal};
}

inline SolidHit meet_box(const SolidBox& box, const glm::dvec3& o, const glm::dvec3& d) {
    double enter = -1e30, leave = 1e30;
    glm::dvec3 normal(0);
    for (int a = 0; a < 3; ++a) {
        if (std::abs(d[a]) < 1e-15) {
            if (o[a] < box.low[a] || o[a] > box.high[a]) return {};
            continue;
        }
        const double t0 = ((d[a] > 0 ? box.low[a] : box.high[a]) - o[a]) / d[a];
        const double t1 = ((d[a] > 0 ? box.high[a] : box.low[a]) - o[a]) / d[a];
        leave = std::min(leave, t1);
        if (t0 <= enter) continue;
        enter = t0;
        normal = glm::dvec3(0);
        normal[a] = d[a] > 0 ? -1 : 1;
    }
    if (enter > leave) return {};
    return {enter, normal};
}

/// The first solid that a ray from outside meets.
inline SolidHit meet_room(const Room& room, const glm::dvec3& o, const glm::dvec3& d) {
    SolidHit best;
    for (const SolidPlane& plane : room.planes) {
        const double approach = glm::dot(plane.normal, d);
        if (approach < 0)
            keep_nearer(best, (plane.offset - glm::dot(plane.normal, o)) / approach, plane.normal);
    }
    for (const SolidSphere& sphere : room.spheres) {
        const glm::dvec3 m = o - sphere.centre;
        const double b = glm::dot(m, d);
        const double q = b * b - glm::dot(m, m) + sphere.radius * sphere.radius;
        if (q <= 0) continue;
        const double t = -b - std::sqrt(q);
        keep_nearer(best, t, (m + t * d) / sphere.radius);
    }
    for (const SolidBox& box : room.boxes) {
        const SolidHit hit = meet_box(box, o, d);
        keep_nearer(best, hit.distance, hit.normal);
    }
    return best;
}

/// A floor 0.6 m below the camera, seen at 31 degrees, a wall 2.5 m off along it; on the floor a
/// ball, and a box that floats. y is down before the camera is tilted.
inline Room table_room() {
    Room room;
    const double tilt = 0.55;
    const glm::dvec3 up{0, -std::cos(tilt), -std::sin(tilt)};
    const glm::dvec3 back{0, std::sin(tilt), -std::cos(tilt)};
    const auto on_floor = [&](double x, double height, double depth) {
        return glm::dvec3(x, 0, 0) + (height - 0.6) * up - depth * back;
    };
    room.planes = {{up, -0.6}, {back, -2.5}};
    room.spheres = {{on_floor(-0.2, 0.15, 1.0), 0.15}, {on_floor(0.45, 0.1, 1.5), 0.1}};
    const glm::dvec3 centre = on_floor(0.15, 0.2, 0.9);
    room.boxes = {{centre - glm::dvec3(0.08, 0.06, 0.05), centre + glm::dvec3(0.08, 0.06, 0.05)}};
    return room;
}

inline Lens room_lens(int width, int height) {
    return {width, height, 0.9 * width, 0.9 * width, 0.5 * (width - 1), 0.5 * (height - 1)};
}

/// What the camera sees of the room; a share of the pixels (0..1) at random are holes.
inline SurfaceMap map_of(const Room& room, const Lens& lens, double holes = 0) {
    SurfaceMap map = empty_surface_map(lens, Pose{});
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            if (uniform({7, 0, std::uint32_t(y * lens.width + x), 0}, 0) < float(holes)) continue;
            const glm::dvec3 ray = unproject(lens, {x, y});
            const SolidHit hit = meet_room(room, glm::dvec3(0), glm::normalize(ray));
            if (!std::isfinite(hit.distance)) continue;
            map.position(x, y) = glm::vec3(hit.distance * glm::normalize(ray));
            map.normal(x, y) = glm::vec3(hit.normal);
            map.confidence(x, y) = 1;
        }
    }
    return map;
}

/// A ray into the hemisphere above a random pixel's surface, `offset` (m) off it, or empty
/// (direction 0) where the pixel is a hole. Cosine-distributed.
inline CameraRay ray_from_surface(const SurfaceMap& map, std::uint32_t number, double offset) {
    const SampleKey key{11, 0, number, 0};
    const int x = int(uniform(key, 0) * float(map.lens.width));
    const int y = int(uniform(key, 1) * float(map.lens.height));
    if (!map.has_surface(x, y)) return {glm::dvec3(0), glm::dvec3(0)};
    const glm::vec3 n = map.normal(x, y);
    const glm::vec3 d =
        basis_about(n) * sample_cosine_hemisphere({uniform(key, 2), uniform(key, 3)}).direction;
    return {glm::dvec3(map.position(x, y)) + offset * glm::dvec3(n), glm::dvec3(d)};
}

inline bool is_ray(const CameraRay& ray) { return glm::dot(ray.direction, ray.direction) > 0; }

/// A ray from anywhere around the view, also from behind the camera and beside the image, in any
/// direction.
inline CameraRay ray_from_anywhere(std::uint32_t number) {
    const SampleKey key{12, 0, number, 0};
    const glm::dvec3 o{3 * uniform(key, 0) - 1.5, 3 * uniform(key, 1) - 1.5,
                       3.5 * uniform(key, 2) - 0.5};
    const double z = 2 * uniform(key, 3) - 1, phi = 6.283185307179586 * uniform(key, 4);
    const double r = std::sqrt(std::max(0.0, 1 - z * z));
    return {o, {r * std::cos(phi), r * std::sin(phi), z}};
}

}  // namespace inlay::test
