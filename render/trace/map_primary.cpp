// Camera rays against the tangent plane of their pixel.
#include "render/trace/map_primary.h"

#include "recordings/base/lens.h"

#include <algorithm>

namespace inlay {
namespace {

/// A map's camera, ready for rays in world coordinates.
struct MapCamera {
    const Lens& lens;
    glm::mat3 rotation;  // world from camera
    float largest_tilt;
};

/// Where a ray meets the plane through p (m) with normal n, both in the camera's frame; planes seen
/// too flat are kept near the depth of p.
RealPrimaryHit on_plane(const MapCamera& camera, const glm::vec3& p, const glm::vec3& n,
                        const glm::vec3& origin, const glm::vec3& direction) {
    const glm::vec3 normal = camera.rotation * n;
    const float at_same_depth = p.z / glm::dot(direction, camera.rotation[2]);
    const float approach = glm::dot(normal, direction);
    const float on_plane = approach < 0 ? glm::dot(normal, camera.rotation * p) / approach : 0.0f;
    const float distance = on_plane > 0
                               ? std::clamp(on_plane, (1 - camera.largest_tilt) * at_same_depth,
                                            (1 + camera.largest_tilt) * at_same_depth)
                               : at_same_depth;
    return {distance, origin + distance * direction, normal};
}

/// Whether a ray through a pixel passes on the second surface's side of the edge in it.
bool meets_second(const MapCamera& camera, const SecondSurface& second, const glm::ivec2& pixel,
                  const glm::vec3& direction) {
    const glm::dvec2 at = project(camera.lens, glm::dvec3(direction * camera.rotation));
    return glm::dot(glm::vec2(at - glm::dvec2(pixel)), second.towards) > second.edge;
}

}  // namespace

RealPrimaryHits map_primary(const SurfaceMap& map, const RayPacket& rays,
                            const std::array<glm::ivec2, packet_width>& pixels,
                            float largest_tilt) {
    RealPrimaryHits hits;
    const MapCamera camera{map.lens, glm::mat3(map.world_from_camera.rotation), largest_tilt};
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!rays.has(lane)) continue;
        const auto i = std::size_t(lane);
        const std::size_t at = map.position.index(pixels[i].x, pixels[i].y);
        const glm::vec3 &origin = rays.origin[i], &direction = rays.direction[i];
        if (map.position.pixels[at].z > 0)
            hits.pixel[i] =
                on_plane(camera, map.position.pixels[at], map.normal.pixels[at], origin, direction);
        const std::uint32_t number = map.split.second.empty() ? 0 : map.split.number.pixels[at];
        if (number == 0) continue;
        const SecondSurface& second = map.split.second[number - 1];
        if (!meets_second(camera, second, pixels[i], direction)) continue;
        hits.split |= 1U << lane;
        if (second.position.z > 0)
            hits.ray[i] = on_plane(camera, second.position, second.normal, origin, direction);
    }
    return hits;
}

}  // namespace inlay
