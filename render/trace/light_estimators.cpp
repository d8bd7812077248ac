#include "render/trace/light_estimators.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Dimensions of the random numbers; 0 is the position within the pixel, and the path tracer behind
/// exact real geometry starts at 64.
enum Dimension : std::uint32_t {
    light = 1,
    diffuse_lobe,
    glossy_lobe,
    light_at_hit,
    lobe_or_light
};

std::uint64_t count(const RayPacket& rays) { return std::uint64_t(std::popcount(rays.active)); }

/// Rays from the landings against one kind of geometry: each kind has its own distance to start at.
struct RayPair {
    RayPacket against_virtual, against_real;

    void set(int lane, const Landing& from, const glm::vec3& direction, float real_offset) {
        const float offset = from.kind == LandingKind::real ? real_offset : surface_offset;
        against_virtual.set(
            lane, ray_origin(from.position, from.geometric_normal, direction, surface_offset),
            direction);
        against_real.set(lane, ray_origin(from.position, from.geometric_normal, direction, offset),
                         direction);
    }
};

/// cos/r (1/m) of an occluder, with distances below the floor counted as the floor, and none below
/// the distance at which rays start.
float occluder_rate(const Landing& from, const glm::vec3& direction, float distance,
                    const SamplingSettings& settings) {
    const float cosine = std::max(0.0f, glm::dot(from.normal, direction));
    return cosine / std::max({distance, settings.occluder_floor * from.distance, surface_offset});
}

void widen(float& rate, float candidate) { rate = std::max(rate, candidate); }

/// One sample of the environment for a surface that an indirect ray met. A glossy surface draws it
/// from its lobe or from the environment, each half of the time, with the density of both together
/// (Veach 1997, one-sample model): else a narrow lobe would meet bright light too rarely.
LightSample light_for_hit(const SamplePass& pass, const Landing& at, const SampleKey& key) {
    const EnvironmentSampler& environment = pass.scene.environment;
    const glm::vec2 u = stratified_pair(key, light_at_hit);
    if (!at.bsdf.glossy) return sample_environment(environment, u);
    LightSample sample;
    if (uniform(key, lobe_or_light) < 0.5f) {
        sample.direction = sample_glossy(at.bsdf, at.frame, u).direction;
        sample.radiance = radiance_from(environment.map, sample.direction);
        sample.pdf = pdf_environment(environment, sample.direction);
    } else {
        sample = sample_environment(environment, u);
    }
    sample.pdf = 0.5f * (sample.pdf + pdf_glossy(at.bsdf, at.frame, sample.direction));
    return sample;
}

/// Radiance that virtual surfaces send back along indirect rays: shaded with one environment sample
/// each, shadowed by real and virtual geometry.
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
        if (!(sample.pdf > 0 && cosine > 0)) continue;
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

/// What a packet of indirect rays brings back, in both modes; 0 where it meets no surface.
struct Bounce {
    RadiancePacket real_only{}, with_virtual{};
    DistancePacket distance;  // of the nearest surface, real or virtual
};

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

}  // namespace

void add_direct(SamplePass& pass) {
    std::array<LightSample, packet_width> lights;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind == LandingKind::nothing) continue;
        lights[i] =
            sample_environment(pass.scene.environment, stratified_pair(pass.keys[i], light));
        if (lights[i].pdf > 0 && glm::dot(from.normal, lights[i].direction) > 0)
            rays.set(lane, from, lights[i].direction, pass.scene.real.offset);
    }
    const HitPacket on_virtual = pass.scene.virtual_objects.intersect(rays.against_virtual);
    const DistancePacket on_real = pass.scene.real.distances(rays.against_real);
    pass.rays.virtual_shadow += count(rays.against_virtual);
    pass.rays.real_shadow += count(rays.against_real);

    const float ignored = pass.settings.ignored_luminance * pass.scene.environment.mean_luminance;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind == LandingKind::nothing) continue;
        PixelSums& sums = pass.sums[i];
        const bool traced = rays.against_virtual.has(lane);
        const float distance = traced ? std::min(on_virtual[i].distance, on_real[i]) : no_hit;
        ReceiverSums& receiver = from.kind == LandingKind::real ? sums.real : sums.virtual_;
        if (distance != no_hit && luminance(lights[i].radiance) >= ignored)
            widen(receiver.occluder_direct,
                  occluder_rate(from, lights[i].direction, distance, pass.settings));

        const float cosine = traced ? glm::dot(from.normal, lights[i].direction) : 0.0f;
        const Rgb unblocked = traced ? lights[i].radiance * (cosine / lights[i].pdf) : Rgb(0);
        const Rgb real_only = traced && on_real[i] == no_hit ? unblocked : Rgb(0);
        const Rgb with_virtual = traced && !on_virtual[i].hit() ? real_only : Rgb(0);
        if (from.kind == LandingKind::real) {
            sums.direct.add(real_only, with_virtual);
            continue;
        }
        sums.direct_virtual.add(with_virtual);
        const float combined =
            lights[i].pdf +
            (traced ? pdf_glossy(from.bsdf, from.frame, lights[i].direction) : 0.0f);
        const bool lit = traced && distance == no_hit;
        sums.glossy_direct.add(lit ? eval_glossy(from.bsdf, from.frame, lights[i].direction) *
                                         lights[i].radiance / combined
                                   : Rgb(0));
    }
}

void add_indirect(SamplePass& pass) {
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const Landing& from = pass.landings[std::size_t(lane)];
        if (from.kind == LandingKind::nothing) continue;
        const glm::vec2 u = stratified_pair(pass.keys[std::size_t(lane)], diffuse_lobe);
        rays.set(lane, from, basis_about(from.normal) * sample_cosine_hemisphere(u).direction,
                 pass.scene.real.offset);
    }
    const Bounce light_back = bounce(pass, rays);
    for (std::size_t i = 0; i < packet_width; ++i) {
        const Landing& from = pass.landings[i];
        if (from.kind == LandingKind::nothing) continue;
        PixelSums& sums = pass.sums[i];
        ReceiverSums& receiver = from.kind == LandingKind::real ? sums.real : sums.virtual_;
        if (light_back.distance[i] != no_hit)
            widen(receiver.occluder_indirect, occluder_rate(from, rays.against_virtual.direction[i],
                                                            light_back.distance[i], pass.settings));
        if (from.kind == LandingKind::real) {
            sums.indirect.add(pi * light_back.real_only[i], pi * light_back.with_virtual[i]);
        } else {
            sums.indirect_virtual.add(pi * light_back.with_virtual[i]);
        }
    }
}

void add_glossy(SamplePass& pass) {
    std::array<DirectionSample, packet_width> lobe;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind != LandingKind::on_virtual || !from.bsdf.glossy) continue;
        lobe[i] = sample_glossy(from.bsdf, from.frame, stratified_pair(pass.keys[i], glossy_lobe));
        if (lobe[i].pdf > 0) rays.set(lane, from, lobe[i].direction, pass.scene.real.offset);
    }
    const Bounce light_back = rays.against_virtual.active != 0 ? bounce(pass, rays) : Bounce{};
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind != LandingKind::on_virtual) continue;
        Rgb value(0);  // also without a lobe: S_RV is a mean over all samples on virtual surfaces
        if (rays.against_virtual.has(lane)) {
            const Rgb scattered = eval_glossy(from.bsdf, from.frame, lobe[i].direction);
            const EnvironmentSampler& environment = pass.scene.environment;
            value = light_back.distance[i] == no_hit
                        ? scattered * radiance_from(environment.map, lobe[i].direction) /
                              (lobe[i].pdf + pdf_environment(environment, lobe[i].direction))
                        : scattered * light_back.with_virtual[i] / lobe[i].pdf;
        }
        pass.sums[i].glossy_indirect.add(value);
    }
}

}  // namespace inlay
