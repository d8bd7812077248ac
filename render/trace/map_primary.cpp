// Camera rays against the tangent plane of their pixel.
#include "render/trace/map_primary.h"

#include <algorithm>

namespace inlay {

std::array<RealPrimaryHit, packet_width> map_primary(
    const SurfaceMap& map, const RayPacket& rays,
    const std::array<glm::ivec2, packet_width>& pixels, float largest_tilt) {
    std::array<RealPrimaryHit, packet_width> hits;
    const glm::mat3 rotation(map.world_from_camera.rotation);
    const glm::vec3 forward = rotation[2];
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (!rays.has(lane) || !map.has_surface(pixels[i].x, pixels[i].y)) continue;
        const glm::vec3 p = map.position(pixels[i].x, pixels[i].y);
        const glm::vec3 normal = rotation * map.normal(pixels[i].x, pixels[i].y);
        const float at_same_depth = p.z / glm::dot(rays.direction[i], forward);
        const float approach = glm::dot(normal, rays.direction[i]);
        const float on_plane = approach < 0 ? glm::dot(normal, rotation * p) / approach : 0.0f;
        const float distance = on_plane > 0
                                   ? std::clamp(on_plane, (1 - largest_tilt) * at_same_depth,
                                                (1 + largest_tilt) * at_same_depth)
                                   : at_same_depth;
        hits[i] = {distance, rays.origin[i] + distance * rays.direction[i], normal};
    }
    return hits;
}

}  // namespace inlay
