#include "render/trace/path_tracer.h"

#include "render/scatter/bsdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr std::uint32_t dimensions_per_vertex = 4;

struct PathVertex {
    SurfacePoint point;
    Bsdf bsdf;
    ScatterFrame frame;
    float glossy_share;  // probability of sampling the glossy lobe
};

struct Path {
    Rgb throughput{1.0f};
    Rgb radiance{0.0f};
    float pdf = 0;  // per steradian, of the direction the path goes; 0: it came from the camera
};

PathVertex vertex_at(const EmbreeScene& scene, const SurfaceHit& hit, const glm::vec3& origin,
                     const glm::vec3& direction) {
    PathVertex v;
    v.point = scene.surface_point(hit, origin, direction);
    v.frame = scatter_frame(v.point.shading_normal, -direction);
    v.bsdf = bsdf_at(scene.parts()[hit.part].material, v.point.uv,
                     -glm::dot(v.frame.world_from_local[2], direction), v.point.vertex_color);
    v.glossy_share = !v.bsdf.glossy ? 0.0f : luminance(v.bsdf.diffuse) > 0 ? 0.5f : 1.0f;
    return v;
}

/// BSDF times cosine (1/sr).
Rgb eval(const PathVertex& v, const glm::vec3& towards_light) {
    const float cosine = std::max(0.0f, glm::dot(v.frame.world_from_local[2], towards_light));
    return v.bsdf.diffuse * (cosine / pi) + eval_glossy(v.bsdf, v.frame, towards_light);
}

float pdf(const PathVertex& v, const glm::vec3& direction) {
    const float cosine = std::max(0.0f, glm::dot(v.frame.world_from_local[2], direction));
    return (1 - v.glossy_share) * cosine / pi +
           (v.glossy_share > 0 ? v.glossy_share * pdf_glossy(v.bsdf, v.frame, direction) : 0.0f);
}

glm::vec3 sample_direction(const PathVertex& v, float choice, glm::vec2 u) {
    if (choice < v.glossy_share) return sample_glossy(v.bsdf, v.frame, u).direction;
    return v.frame.world_from_local * sample_cosine_hemisphere(u).direction;
}

/// Radiance of the light sample after scattering, before visibility; 0 where it cannot contribute.
Rgb light_contribution(const PathVertex& v, const LightSample& light) {
    if (!(light.pdf > 0)) return Rgb(0);
    return eval(v, light.direction) * light.radiance / (light.pdf + pdf(v, light.direction));
}

/// Moves a path on from its vertex; false ends it.
bool scatter(Path& path, const PathVertex& v, const SampleKey& key, std::uint32_t dimension,
             bool roulette, glm::vec3& direction) {
    direction =
        sample_direction(v, uniform(key, dimension + 1), stratified_pair(key, dimension + 2));
    path.pdf = pdf(v, direction);
    if (!(path.pdf > 0)) return false;
    path.throughput *= eval(v, direction) / path.pdf;
    if (roulette) {
        const float survival = std::min(0.95f, luminance(path.throughput));
        if (!(uniform(key, dimension + 3) < survival)) return false;
        path.throughput /= survival;
    }
    return luminance(path.throughput) > 0;
}

/// Light of the environment along a ray that hit nothing.
Rgb environment_light(const EnvironmentSampler& environment, const Path& path,
                      const glm::vec3& direction) {
    const Rgb radiance = path.throughput * radiance_from(environment.map, direction);
    if (path.pdf == 0) return radiance;
    return radiance * (path.pdf / (path.pdf + pdf_environment(environment, direction)));
}

}  // namespace

RadiancePacket trace_paths(const EmbreeScene& scene, const EnvironmentSampler& environment,
                           const RayPacket& rays, const SampleKeys& keys,
                           const PathSettings& settings) {
    std::array<Path, packet_width> paths;
    RayPacket current = rays;
    for (int depth = 0; depth <= settings.max_vertices && current.active; ++depth) {
        const std::uint32_t dimension =
            settings.dimension + std::uint32_t(depth) * dimensions_per_vertex;
        const HitPacket hits = scene.intersect(current);
        RayPacket next, shadow;
        std::array<Rgb, packet_width> light_radiance;
        for (int lane = 0; lane < packet_width; ++lane) {
            if (!current.has(lane)) continue;
            const auto i = std::size_t(lane);
            Path& path = paths[i];
            if (!hits[i].hit()) {
                path.radiance += environment_light(environment, path, current.direction[i]);
                continue;
            }
            if (depth == settings.max_vertices) continue;
            const PathVertex v = vertex_at(scene, hits[i], current.origin[i], current.direction[i]);
            const LightSample light =
                sample_environment(environment, stratified_pair(keys[i], dimension));
            light_radiance[i] = path.throughput * light_contribution(v, light);
            if (luminance(light_radiance[i]) > 0) {
                shadow.set(lane,
                           ray_origin(v.point.position, v.point.geometric_normal, light.direction,
                                      surface_offset),
                           light.direction);
            }
            glm::vec3 direction;
            if (scatter(path, v, keys[i], dimension, depth >= settings.roulette_after, direction)) {
                next.set(lane,
                         ray_origin(v.point.position, v.point.geometric_normal, direction,
                                    surface_offset),
                         direction);
            }
        }
        const std::uint32_t blocked = scene.occluded(shadow);
        for (int lane = 0; lane < packet_width; ++lane) {
            if (shadow.has(lane) && !((blocked >> lane) & 1U))
                paths[std::size_t(lane)].radiance += light_radiance[std::size_t(lane)];
        }
        current = next;
    }
    RadiancePacket result;
    for (std::size_t i = 0; i < packet_width; ++i)
        result[i] = paths[i].radiance;
    return result;
}

}  // namespace inlay
