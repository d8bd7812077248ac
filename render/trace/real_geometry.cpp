#include "render/trace/real_geometry.h"

#include "render/trace/map_primary.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace inlay {
namespace {

DistancePacket distances_of(const HitPacket& hits) {
    DistancePacket result;
    for (std::size_t i = 0; i < packet_width; ++i)
        result[i] = hits[i].distance;
    return result;
}

/// Radiance that the photograph shows at a world point, if it sees it.
std::optional<Rgb> photographed(const PhotographedSurface& seen, const Pose& camera_from_world,
                                const glm::vec3& world, float tolerance) {
    const SurfaceMap& map = seen.surface;
    const glm::dvec3 p = camera_from_world * glm::dvec3(world);
    if (!(p.z > 0)) return std::nullopt;
    const auto pixel = nearest_pixel(map.lens, project(map.lens, p));
    if (!pixel || !map.has_surface(pixel->x, pixel->y)) return std::nullopt;
    if (std::abs(map.position(pixel->x, pixel->y).z - float(p.z)) > tolerance) return std::nullopt;
    return seen.photo(pixel->x, pixel->y);
}

}  // namespace

RealGeometry no_real_geometry() {
    DistancePacket nothing;
    nothing.fill(no_hit);
    return {[](const RayPacket&, const auto&) { return RealPrimaryHits{}; },
            [nothing](const RayPacket&) { return nothing; }, [](const RayPacket&) { return 0U; },
            [nothing](const RayPacket&, const SampleKeys&) {
                return RealHits{nothing, {}};
            }};
}

RealGeometry exact_real_geometry(const EmbreeScene& scene, const EnvironmentSampler& environment,
                                 std::uint32_t dimension) {
    RealGeometry real;
    real.primary = [&scene](const RayPacket& rays, const auto&) {
        RealPrimaryHits result;
        const HitPacket hits = scene.intersect(rays);
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (!hits[i].hit()) continue;
            const SurfacePoint point =
                scene.surface_point(hits[i], rays.origin[i], rays.direction[i]);
            const bool behind = glm::dot(point.shading_normal, rays.direction[i]) > 0;
            result.pixel[i] = {hits[i].distance, point.position,
                               behind ? -point.shading_normal : point.shading_normal};
        }
        return result;
    };
    real.distances = [&scene](const RayPacket& rays) {
        return distances_of(scene.intersect(rays));
    };
    real.occluded = [&scene](const RayPacket& rays) { return scene.occluded(rays); };
    real.radiances = [&scene, &environment, dimension](const RayPacket& rays,
                                                       const SampleKeys& keys) {
        RealHits result{distances_of(scene.intersect(rays)), {}};
        RayPacket hitting = rays;
        for (int lane = 0; lane < packet_width; ++lane)
            if (result.distance[std::size_t(lane)] == no_hit) hitting.active &= ~(1U << lane);
        PathSettings settings;
        settings.dimension = dimension;
        result.radiance = trace_paths(scene, environment, hitting, keys, settings);
        return result;
    };
    return real;
}

RealGeometry mesh_alone(const EmbreeScene& mesh, float offset) {
    RealGeometry real = no_real_geometry();
    real.offset = offset;
    real.distances = [&mesh](const RayPacket& rays) { return distances_of(mesh.intersect(rays)); };
    real.occluded = [&mesh](const RayPacket& rays) { return mesh.occluded(rays); };
    real.radiances = [&mesh](const RayPacket& rays, const SampleKeys&) {
        const HitPacket hits = mesh.intersect(rays);
        RealHits result{distances_of(hits), {}};
        for (std::size_t i = 0; i < packet_width; ++i)
            if (hits[i].hit()) result.radiance[i] = mesh.vertex_color(hits[i]);
        return result;
    };
    return real;
}

RealGeometry mesh_real_geometry(const PhotographedSurface& seen, const EmbreeScene& mesh,
                                float offset, float visibility_tolerance) {
    RealGeometry real = mesh_alone(mesh, offset);
    real.primary = [&map = seen.surface](const RayPacket& rays, const auto& pixels) {
        return map_primary(map, rays, pixels);
    };
    real.radiances = [seen, &mesh, visibility_tolerance,
                      camera_from_world = inverse(seen.surface.world_from_camera)](
                         const RayPacket& rays, const SampleKeys&) {
        const HitPacket hits = mesh.intersect(rays);
        RealHits result{distances_of(hits), {}};
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (!hits[i].hit()) continue;
            const glm::vec3 at = rays.origin[i] + hits[i].distance * rays.direction[i];
            const auto photo = photographed(seen, camera_from_world, at, visibility_tolerance);
            result.radiance[i] = photo ? *photo : mesh.vertex_color(hits[i]);
        }
        return result;
    };
    return real;
}

TriangleMesh triangulate(const PhotographedSurface& seen, float max_step) {
    const SurfaceMap& map = seen.surface;
    TriangleMesh mesh;
    constexpr std::uint32_t none = 0xffffffffU;
    Image<std::uint32_t> vertex(map.lens.width, map.lens.height, none);
    for (int y = 0; y < map.lens.height; ++y) {
        for (int x = 0; x < map.lens.width; ++x) {
            if (!map.has_surface(x, y)) continue;
            vertex(x, y) = std::uint32_t(mesh.positions.size());
            mesh.positions.emplace_back(map.world_from_camera * glm::dvec3(map.position(x, y)));
            mesh.colors.push_back(seen.photo(x, y));
        }
    }
    const auto add = [&](glm::ivec2 a, glm::ivec2 b, glm::ivec2 c) {
        const float za = map.position(a.x, a.y).z, zb = map.position(b.x, b.y).z,
                    zc = map.position(c.x, c.y).z;
        const float nearest = std::min({za, zb, zc}), farthest = std::max({za, zb, zc});
        if (nearest > 0 && farthest - nearest <= max_step * nearest)
            mesh.triangles.emplace_back(vertex(a.x, a.y), vertex(b.x, b.y), vertex(c.x, c.y));
    };
    for (int y = 0; y + 1 < map.lens.height; ++y) {
        for (int x = 0; x + 1 < map.lens.width; ++x) {
            add({x, y}, {x, y + 1}, {x + 1, y});
            add({x + 1, y}, {x, y + 1}, {x + 1, y + 1});
        }
    }
    return mesh;
}

}  // namespace inlay
