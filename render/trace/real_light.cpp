#include "render/trace/real_light.h"

#include "render/trace/bounce.h"

#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

bool is_real(const Landing& landing) { return landing.kind == LandingKind::real; }

/// Share of an open surface's irradiance above which a change is plainly seen.
constexpr float shown_change = 0.06f;

}  // namespace

int real_light_samples(const TwoModeScene& scene, const SamplingSettings& settings,
                       const ChangeSums& change) {
    const glm::dvec3 sum = glm::abs(change.direct) + glm::abs(change.indirect);
    const float shown = shown_change * pi * scene.environment.mean_luminance;
    const bool is_shown = luminance(Rgb(sum)) > shown * float(change.camera_rays);
    const int most = most_real_light_samples(settings);
    return is_shown ? most : std::max(1, most / 4);
}

int most_real_light_samples(const SamplingSettings& settings) { return settings.secondary; }

void add_real_direct(SamplePass& pass, const LaneCounts& counts) {
    std::array<LightSample, packet_width> lights;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (!is_real(from)) continue;
        lights[i] =
            light_sample(pass, pass.keys[i], light_direction, pass.settings.primary * counts[i]);
        if (lights[i].pdf > 0 && glm::dot(from.normal, lights[i].direction) > 0)
            rays.set(lane, from, lights[i].direction, pass.scene.real.offset);
    }
    const DistancePacket on_real = pass.scene.real.distances(rays.against_real);
    pass.rays.real_shadow += count(rays.against_real);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (!is_real(from)) continue;
        PixelSums& sums = pass.sums[i];
        Rgb open(0);
        bool blocked = false;
        if (rays.against_real.has(lane)) {
            open =
                lights[i].radiance * (glm::dot(from.normal, lights[i].direction) / lights[i].pdf);
            blocked = on_real[i] != no_hit;
        }
        if (blocked && counts_as_occluded(pass, lights[i].radiance))
            widen(sums.real.occluder_direct,
                  occluder_rate(from, lights[i].direction, on_real[i], pass.settings));
        const Rgb shadowed = blocked ? Rgb(0) : open;
        sums.direct.add(shadowed, shadowed);
        if (pass.settings.unshadowed) sums.unshadowed_real.add(open);
    }
}

void add_real_indirect(SamplePass& pass) {
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const Landing& from = pass.landings[std::size_t(lane)];
        if (!is_real(from)) continue;
        const glm::vec2 u = stratified_pair(pass.keys[std::size_t(lane)], diffuse_lobe);
        rays.set(lane, from, basis_about(from.normal) * sample_cosine_hemisphere(u).direction,
                 pass.scene.real.offset);
    }
    const RealHits back = pass.scene.real.radiances(rays.against_real, pass.keys);
    pass.rays.real_indirect += count(rays.against_real);
    for (std::size_t i = 0; i < packet_width; ++i) {
        const Landing& from = pass.landings[i];
        if (!is_real(from)) continue;
        PixelSums& sums = pass.sums[i];
        Rgb light(0);
        if (back.distance[i] != no_hit) {
            light = pi * back.radiance[i];
            widen(sums.real.occluder_indirect, occluder_rate(from, rays.against_real.direction[i],
                                                             back.distance[i], pass.settings));
        }
        sums.indirect.add(light, light);
    }
}

}  // namespace inlay
