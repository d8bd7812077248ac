#include "render/trace/real_light.h"

#include "render/trace/bounce.h"
#include "render/trace/sample_tile.h"

#include <algorithm>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

bool is_real(const Landing& landing) { return landing.kind == LandingKind::real; }

/// One sample of the environment's light on real surfaces, shadowed by real geometry. `counts` are
/// the samples that each pixel takes in all.
void add_real_direct(SamplePass& pass, const LaneCounts& counts) {
    std::array<LightSample, packet_width> lights;
    RayPair rays;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (!is_real(from)) continue;
        lights[i] = light_sample(pass, i, LandingKind::real, counts[i]);
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

/// One bounce along the cosine lobe of real surfaces, which meets real geometry alone. `counts` as
/// above.
void add_real_indirect(SamplePass& pass, const LaneCounts& counts) {
    RayPair rays;
    const StratifiedSet points = frame_set(pass.keys[0], diffuse_lobe);
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = pass.landings[i];
        if (!is_real(from)) continue;
        const glm::vec2 u = point_of(points, pass.keys[i], counts[i]);
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

/// What a pixel has taken of the samples that it wants.
struct Progress {
    LaneCounts taken{}, landed{};  // samples, and camera rays on real surfaces
};

/// The samples that fall to the rays at hand, one after the other.
void add_from_rays(const TilePass& pass, const Landings& landings, const LaneCounts& counts,
                   Progress& progress) {
    const int rays = pass.settings.primary;
    LaneCounts ends{};
    int most = 0;
    for (std::size_t i = 0; i < packet_width; ++i) {
        ends[i] = progress.taken[i];
        if (!is_real(landings[i]) || progress.taken[i] == counts[i]) continue;
        ends[i] = (counts[i] * ++progress.landed[i] + rays - 1) / rays;
        most = std::max(most, ends[i] - progress.taken[i]);
    }
    for (int s = 0; s < most; ++s) {
        Landings sampled;
        SampleKeys keys = pass.keys(0);
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (progress.taken[i] == ends[i]) continue;
            sampled[i] = landings[i];
            keys[i].sample = std::uint32_t(progress.taken[i]++);
        }
        SamplePass sample = pass.from(sampled, keys);
        add_real_light(sample, counts);
    }
}

/// `counts` samples (0: none) of each pixel.
void sample_real_light(const TilePass& pass, const LaneCounts& counts) {
    const int camera_rays = most_camera_rays(pass.settings);
    Progress progress;
    for (int ray = 0; ray < camera_rays; ++ray) {
        std::uint32_t wanting = 0;
        for (std::size_t i = 0; i < packet_width; ++i)
            if (counts[i] > progress.taken[i] &&
                (ray < pass.settings.primary || progress.landed[i] == 0))
                wanting |= 1U << i;
        if (wanting == 0) return;
        add_from_rays(pass, pass.land_at(ray, wanting), counts, progress);
    }
}

}  // namespace

int most_real_light_samples(const SamplingSettings& settings) {
    return settings.primary * settings.secondary;
}

void add_real_light(SamplePass& pass, const LaneCounts& counts) {
    add_real_direct(pass, counts);
    add_real_indirect(pass, counts);
}

void light_real_surfaces(const TilePass& pass, std::uint32_t chosen, const NoisyLayers& layers,
                         const Image<LightNeed>& needs) {
    const int most = most_real_light_samples(pass.settings);
    LaneCounts counts{};
    for_each_lane(pass.tile, [&](std::size_t lane, const PixelSums&) {
        const glm::ivec2 p = pass.tile.area.pixels[lane];
        if (layers.real.object(p.x, p.y) != 0 && (chosen >> lane) & 1U)
            counts[lane] = samples_for(needs(p.x, p.y), most);
    });
    sample_real_light(pass, counts);
}

}  // namespace inlay
