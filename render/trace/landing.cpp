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

namespace {

/// Whether a real surface hides the virtual one: measured depth is noisy.
bool hides(const RealPrimaryHit& real, const SurfaceHit& on_virtual, float depth_tolerance) {
    return real.distance * (1 + depth_tolerance) < on_virtual.distance;
}

/// The real surface that counts for a ray: the pixel's own, unless a virtual surface stands between
/// the two that the pixel sees.
const RealPrimaryHit& real_hit(const RealPrimaryHits& hits, std::size_t lane,
                               const SurfaceHit& on_virtual, float depth_tolerance) {
    const bool split = (hits.split >> lane & 1U) != 0;
    const bool between = split && on_virtual.hit() &&
                         hides(hits.pixel[lane], on_virtual, depth_tolerance) !=
                             hides(hits.ray[lane], on_virtual, depth_tolerance);
    return between ? hits.ray[lane] : hits.pixel[lane];
}

}  // namespace

Landings land(const RealGeometry& real, const EmbreeScene& objects, const RayPacket& rays,
              const std::array<glm::ivec2, packet_width>& pixels, float depth_tolerance) {
    const HitPacket on_virtual = objects.intersect(rays);
    const auto on_real = real.primary(rays, pixels);
    Landings landings;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!rays.has(lane)) continue;
        const auto i = std::size_t(lane);
        const RealPrimaryHit& seen = real_hit(on_real, i, on_virtual[i], depth_tolerance);
        if (on_virtual[i].hit() && !hides(seen, on_virtual[i], depth_tolerance)) {
            landings[i] =
                land_on_virtual(objects, on_virtual[i], rays.origin[i], rays.direction[i]);
        } else if (seen.distance != no_hit && glm::dot(seen.normal, seen.normal) > 0) {
            Landing& landing = landings[i];
            landing.kind = LandingKind::real;
            landing.distance = seen.distance;
            landing.position = seen.position;
            landing.normal = landing.geometric_normal = seen.normal;
            landing.object = 1;
        }
    }
    return landings;
}

}  // namespace inlay
