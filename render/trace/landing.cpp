#include "render/trace/landing.h"

namespace inlay {

Landing land_on_virtual(const EmbreeScene& objects, const SurfaceHit& hit, const glm::vec3& origin,
                        const glm::vec3& direction) {
    const PlacedPart& part = objects.parts()[hit.part];
    const SurfacePoint point = objects.surface_point(hit, origin, direction);
    Landing landing;
    landing.kind = LandingKind::on_virtual;
    landing.distance = hit.distance;
    landing.position = point.position;
    const bool behind = glm::dot(point.geometric_normal, direction) > 0;
    landing.geometric_normal = behind ? -point.geometric_normal : point.geometric_normal;
    landing.frame = scatter_frame(point.shading_normal, -direction);
    landing.normal = landing.frame.world_from_local[2];
    landing.bsdf =
        bsdf_at(part.material, point.uv, -glm::dot(landing.normal, direction), point.vertex_color);
    landing.object = part.object + 1;
    return landing;
}

Landings land(const RealGeometry& real, const EmbreeScene& objects, const RayPacket& rays,
              const std::array<glm::ivec2, packet_width>& pixels, float depth_tolerance) {
    const HitPacket on_virtual = objects.intersect(rays);
    const auto on_real = real.primary(rays, pixels);
    Landings landings;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!rays.has(lane)) continue;
        const auto i = std::size_t(lane);
        const float tolerated = on_real[i].distance * (1 + depth_tolerance);
        if (on_virtual[i].hit() && !(tolerated < on_virtual[i].distance)) {
            landings[i] =
                land_on_virtual(objects, on_virtual[i], rays.origin[i], rays.direction[i]);
        } else if (on_real[i].distance != no_hit &&
                   glm::dot(on_real[i].normal, on_real[i].normal) > 0) {
            Landing& landing = landings[i];
            landing.kind = LandingKind::real;
            landing.distance = on_real[i].distance;
            landing.position = on_real[i].position;
            landing.normal = landing.geometric_normal = on_real[i].normal;
            landing.object = 1;
        }
    }
    return landings;
}

}  // namespace inlay
