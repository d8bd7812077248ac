#include "render/trace/light_estimators.h"

#include "render/trace/bounce.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// What became of one shadow ray.
struct ShadowRay {
    bool traced = false;                          // the light is above the surface
    float to_virtual = no_hit, to_real = no_hit;  // m, distances of the nearest occluders

    float distance() const { return std::min(to_virtual, to_real); }
};

/// Adds one environment sample to a pixel, in both modes. An untraced one counts as 0.
void add_light_sample(const SamplePass& pass, const Landing& from, const LightSample& light,
                      const ShadowRay& shadow, PixelSums& sums) {
    if (shadow.distance() != no_hit && counts_as_occluded(pass, light.radiance))
        widen(receiver_of(sums, from.kind).occluder_direct,
              occluder_rate(from, light.direction, shadow.distance(), pass.settings));
    Rgb unshadowed(0), real_only(0), with_virtual(0), glossy(0);
    if (shadow.traced)
        unshadowed = light.radiance * (glm::dot(from.normal, light.direction) / light.pdf);
    if (shadow.to_real == no_hit) real_only = unshadowed;
    if (pass.settings.unshadowed) {
        (from.kind == LandingKind::real ? sums.unshadowed_real : sums.unshadowed_virtual)
            .add(unshadowed);
    }
    if (shadow.to_virtual == no_hit) with_virtual = real_only;
    if (from.kind == LandingKind::real) {
        sums.direct.add(real_only, with_virtual);
        return;
    }
    sums.direct_virtual.add(with_virtual);
    if (!pass.settings.glossy_seen) return;
    if (shadow.traced && shadow.distance() == no_hit)
        glossy = eval_glossy(from.bsdf, from.frame, light.direction) * light.radiance /
                 (light.pdf + pdf_glossy(from.bsdf, from.frame, light.direction));
    sums.glossy_direct.add(glossy);
}

/// A light sample for each landing; a ray for those above the surface.
struct DirectRays {
    std::array<LightSample, packet_width> lights;
    RayPair rays;
};

DirectRays direct_rays(const SamplePass& pass) {
    DirectRays result;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind == LandingKind::nothing) continue;
        LightSample& light = result.lights[i];
        light = light_sample(pass, i, from.kind, light_samples_on(from.kind, pass.settings));
        if (light.pdf > 0 && glm::dot(from.normal, light.direction) > 0)
            result.rays.set(lane, from, light.direction, pass.scene.real.offset);
    }
    return result;
}

RayPair diffuse_rays(const SamplePass& pass) {
    RayPair rays;
    const StratifiedSet points = frame_set(pass.keys[0], diffuse_lobe);
    for (int lane = 0; lane < packet_width; ++lane) {
        const Landing& from = pass.landings[std::size_t(lane)];
        if (from.kind == LandingKind::nothing) continue;
        const glm::vec2 u = point_of(points, pass.keys[std::size_t(lane)],
                                     light_samples_on(from.kind, pass.settings));
        rays.set(lane, from, basis_about(from.normal) * sample_cosine_hemisphere(u).direction,
                 pass.scene.real.offset);
    }
    return rays;
}

}  // namespace

std::uint32_t lanes_meeting_virtual(SamplePass& pass) {
    const RayPacket direct = direct_rays(pass).rays.against_virtual,
                    indirect = diffuse_rays(pass).against_virtual;
    pass.rays.virtual_shadow += count(direct);
    pass.rays.virtual_indirect += count(indirect);
    const EmbreeScene& objects = pass.scene.virtual_objects;
    return objects.occluded(direct) | objects.occluded(indirect);
}

void add_direct(SamplePass& pass) {
    const auto [lights, rays] = direct_rays(pass);
    const HitPacket on_virtual = pass.scene.virtual_objects.intersect(rays.against_virtual);
    const DistancePacket on_real = pass.scene.real.distances(rays.against_real);
    pass.rays.virtual_shadow += count(rays.against_virtual);
    pass.rays.real_shadow += count(rays.against_real);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (pass.landings[i].kind == LandingKind::nothing) continue;
        ShadowRay shadow;
        if (rays.against_virtual.has(lane)) shadow = {true, on_virtual[i].distance, on_real[i]};
        add_light_sample(pass, pass.landings[i], lights[i], shadow, pass.sums[i]);
    }
}

void add_indirect(SamplePass& pass) {
    const RayPair rays = diffuse_rays(pass);
    const Bounce light_back = bounce(pass, rays);
    for (std::size_t i = 0; i < packet_width; ++i) {
        const Landing& from = pass.landings[i];
        if (from.kind == LandingKind::nothing) continue;
        PixelSums& sums = pass.sums[i];
        ReceiverSums& receiver = receiver_of(sums, from.kind);
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
    const StratifiedSet points = frame_set(pass.keys[0], glossy_lobe);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (from.kind != LandingKind::on_virtual || !from.bsdf.glossy) continue;
        lobe[i] = sample_glossy(
            from.bsdf, from.frame,
            point_of(points, pass.keys[i], light_samples_on(from.kind, pass.settings)));
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
