#include "render/trace/bounce.h"

#include <algorithm>
#include <bit>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// One sample of the environment for a surface that an indirect ray met. A glossy surface draws it
/// from its lobe or from the environment, each half of the time, with the density of both together
/// (Veach 1997, one-sample model): else a narrow lobe would meet bright light too rarely.
LightSample light_for_hit(const SamplePass& pass, const Landing& at, const SampleKey& key) {
    const EnvironmentSampler& environment = pass.scene.environment;
    const LightSample& light = pass.nets.at(
        light_run(pass, key, light_at_hit, light_samples_on(LandingKind::real, pass.settings)),
        int(key.sample));
    if (!at.bsdf.glossy) return light;
    const glm::vec2 u = stratified_pair(key, glossy_lobe_at_hit);
    LightSample sample;
    if (uniform(key, lobe_or_light) < 0.5f) {
        sample.direction = sample_glossy(at.bsdf, at.frame, u).direction;
        sample.radiance = radiance_from(environment.map, sample.direction);
        sample.pdf = pdf_environment(environment, sample.direction);
    } else {
        sample = light;
    }
    sample.pdf = 0.5f * (sample.pdf + pdf_glossy(at.bsdf, at.frame, sample.direction));
    return sample;
}

}  // namespace

std::uint64_t count(const RayPacket& rays) { return std::uint64_t(std::popcount(rays.active)); }

void RayPair::set(int lane, const Landing& from, const glm::vec3& direction, float real_offset) {
    const float offset = from.kind == LandingKind::real ? real_offset : surface_offset;
    against_virtual.set(lane,
                        ray_origin(from.position, from.geometric_normal, direction, surface_offset),
                        direction);
    against_real.set(lane, ray_origin(from.position, from.geometric_normal, direction, offset),
                     direction);
}

RadiancePacket shade_virtual_hits(SamplePass& pass, const RayPacket& rays, const HitPacket& hits,
                                  std::uint32_t lanes) {
    RadiancePacket radiance{};
    RayPacket shadow;
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((lanes >> lane) & 1U)) continue;
        const auto i = std::size_t(lane);
        const Landing at =
            land_on_virtual(pass.scene.virtual_objects, hits[i], rays.origin[i], rays.direction[i]);
        const LightSample sample = light_for_hit(pass, at, pass.keys[i]);
        const float cosine = glm::dot(at.normal, sample.direction);
        if (!(sample.pdf > 0 && cosine > 0) || sample.radiance == Rgb(0)) continue;
        radiance[i] =
            (at.bsdf.diffuse * (cosine / pi) + eval_glossy(at.bsdf, at.frame, sample.direction)) *
            sample.radiance / sample.pdf;
        shadow.set(lane,
                   ray_origin(at.position, at.geometric_normal, sample.direction, surface_offset),
                   sample.direction);
    }
    if (shadow.active == 0) return radiance;
    const std::uint32_t by_virtual = pass.scene.virtual_objects.occluded(shadow);
    const DistancePacket by_real = pass.scene.real.distances(shadow);
    pass.rays.virtual_shadow += count(shadow);
    pass.rays.real_shadow += count(shadow);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (((by_virtual >> lane) & 1U) || by_real[i] != no_hit) radiance[i] = Rgb(0);
    }
    return radiance;
}

Bounce bounce(SamplePass& pass, const RayPair& rays) {
    const HitPacket on_virtual = pass.scene.virtual_objects.intersect(rays.against_virtual);
    const RealHits on_real = pass.scene.real.radiances(rays.against_real, pass.keys);
    pass.rays.virtual_indirect += count(rays.against_virtual);
    pass.rays.real_indirect += count(rays.against_real);
    std::uint32_t virtual_nearest = 0;
    Bounce result;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        result.distance[i] = std::min(on_virtual[i].distance, on_real.distance[i]);
        if (on_real.distance[i] != no_hit) result.real_only[i] = on_real.radiance[i];
        if (on_virtual[i].hit() && on_virtual[i].distance <= on_real.distance[i])
            virtual_nearest |= 1U << lane;
    }
    result.with_virtual =
        shade_virtual_hits(pass, rays.against_virtual, on_virtual, virtual_nearest);
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!((virtual_nearest >> lane) & 1U))
            result.with_virtual[std::size_t(lane)] = result.real_only[std::size_t(lane)];
    }
    return result;
}

}  // namespace inlay
