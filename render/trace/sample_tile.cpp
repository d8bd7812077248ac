#include "render/trace/sample_tile.h"

#include "render/trace/change_estimator.h"
#include "render/trace/light_estimators.h"

#include <algorithm>
#include <array>
#include <span>

namespace inlay {
namespace {

void receive(const Landing& landing, PixelSums& sums) {
    ReceiverSums& receiver = receiver_of(sums, landing.kind);
    if (receiver.hits++ == 0) receiver.object = landing.object;
    receiver.position += glm::dvec3(landing.position);
    receiver.normal += glm::dvec3(landing.normal);
    if (landing.kind == LandingKind::on_virtual)
        sums.glossy_bandwidth = std::max(sums.glossy_bandwidth, glossy_bandwidth(landing.bsdf));
}

/// What a camera ray tells about the pixel's coverage and reflectance.
void look(const Landing& landing, PixelSums& sums) {
    ++sums.looks;
    if (landing.kind != LandingKind::on_virtual) return;
    ++sums.looks_virtual;
    sums.albedo.add(landing.bsdf.diffuse);
}

void add_samples(const TilePass& pass, const Landings& landings, int first_sample) {
    for (int s = 0; s < pass.settings.secondary; ++s) {
        SamplePass sample = pass.from(landings, pass.keys(first_sample + s));
        add_direct(sample);
        add_indirect(sample);
        if (pass.settings.glossy_seen) add_glossy(sample);
    }
}

/// Light samples of what camera rays of each pixel met, but for E_R where it is sampled for itself.
/// Each ray takes the sample numbers that follow those of the ray before it, so that a pixel's
/// samples are spread as one sequence.
void gather_light(const TilePass& pass, std::span<const Landings> camera_rays, int first_ray) {
    const bool both_modes = pass.settings.estimator == Estimator::two_mode;
    if (!both_modes) add_changes(pass, camera_rays, first_ray);
    for (const Landings& landings : camera_rays) {
        const int first_sample = first_ray++ * pass.settings.secondary;
        if (both_modes) {
            add_samples(pass, landings, first_sample);
            continue;
        }
        const Landings on_virtual = only(LandingKind::on_virtual, landings);
        if (any_landing(on_virtual)) add_samples(pass, on_virtual, first_sample);
    }
}

/// Camera rays of a pixel whose light is gathered together.
constexpr int rays_at_once = 4;

bool sees_virtual(const Tile& tile) {
    return std::any_of(tile.sums.begin(), tile.sums.end(),
                       [](const PixelSums& sums) { return sums.looks_virtual > 0; });
}

/// Real surfaces receive no light where none is needed.
Landings where_needed(const Landings& landings, std::uint32_t needed) {
    Landings result = landings;
    for (std::size_t lane = 0; lane < packet_width; ++lane)
        if (landings[lane].kind == LandingKind::real && !((needed >> lane) & 1U)) result[lane] = {};
    return result;
}

/// Looks again at a tile with virtual surfaces: their edges and textures need more camera rays than
/// the light on real surfaces does, and their light is sampled where some of these rays meet them.
/// A kind of surface that only the other rays meet gets light samples too.
void refine(const TilePass& pass, std::uint32_t needed) {
    const SamplingSettings& settings = pass.settings;
    const int lit = settings.primary * settings.virtual_repeats;
    Landings missed_real, missed_virtual;  // both kinds may be missed in one pixel
    for (int p = settings.primary; p < most_camera_rays(settings); ++p) {
        const Landings landings = pass.land_at(p);
        for_each_lane(pass.tile, [&](std::size_t lane, PixelSums& sums) {
            const Landing& landing = landings[lane];
            if (p < settings.coverage) look(landing, sums);
            if (landing.kind == LandingKind::nothing) return;
            const bool is_virtual = landing.kind == LandingKind::on_virtual;
            if (is_virtual && p < lit) {
                receive(landing, sums);
            } else if (receiver_of(sums, landing.kind).hits == 0) {
                receive(landing, sums);
                (is_virtual ? missed_virtual : missed_real)[lane] = landing;
            }
        });
        if (p >= lit) continue;
        const Landings on_virtual = only(LandingKind::on_virtual, landings);
        if (any_landing(on_virtual)) add_samples(pass, on_virtual, p * settings.secondary);
    }
    for (const Landings& missed : {where_needed(missed_real, needed), missed_virtual})
        if (any_landing(missed)) gather_light(pass, {&missed, 1}, lit);
}

}  // namespace

int most_camera_rays(const SamplingSettings& settings) {
    return std::max(settings.coverage, settings.primary * settings.virtual_repeats);
}

int largest_net_use(const TwoModeScene& scene, const SamplingSettings& settings) {
    const int on_virtual = settings.virtual_repeats * settings.secondary;
    const int on_real = settings.estimator == Estimator::difference
                            ? change_counts(scene, settings).light
                            : settings.secondary;
    return settings.primary * std::max({on_virtual, on_real, 1});
}

void sample_tile(const TilePass& pass, std::uint32_t needed) {
    std::array<Landings, rays_at_once> camera_rays;
    for (int first = 0; first < pass.settings.primary; first += rays_at_once) {
        const int count = std::min(rays_at_once, pass.settings.primary - first);
        for (int k = 0; k < count; ++k) {
            const Landings landings = pass.land_at(first + k);
            for_each_lane(pass.tile, [&](std::size_t lane, PixelSums& sums) {
                look(landings[lane], sums);
                if (landings[lane].kind != LandingKind::nothing) receive(landings[lane], sums);
            });
            camera_rays[std::size_t(k)] = where_needed(landings, needed);
        }
        gather_light(pass, {camera_rays.data(), std::size_t(count)}, first);
    }
    if (sees_virtual(pass.tile)) refine(pass, needed);
}

std::uint32_t touched_lanes(const TilePass& pass) {
    std::uint32_t touched = 0;
    for (int p = 0; p < pass.settings.primary; ++p) {
        const Landings landings = pass.land_at(p);
        for (const Landing& landing : landings)
            if (landing.kind == LandingKind::on_virtual) return pass.tile.area.inside;
        for (int s = 0; s < pass.settings.secondary; ++s) {
            SamplePass sample = pass.from(landings, pass.keys(p * pass.settings.secondary + s));
            touched |= lanes_meeting_virtual(sample);
        }
    }
    return touched;
}

}  // namespace inlay
