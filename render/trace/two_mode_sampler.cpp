#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/trace/change_estimator.h"
#include "render/trace/light_estimators.h"
#include "render/trace/pixel_tile.h"
#include "render/trace/real_light.h"

#include <algorithm>
#include <bit>
#include <string>
#include <utility>
#include <vector>

namespace inlay {
namespace {

struct Tile {
    PixelTile area;
    std::array<PixelSums, packet_width> sums;
    RayCounts rays;
};

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

/// Environment samples that one estimator of a pixel takes one after the other.
int largest_net_use(const TwoModeScene& scene, const SamplingSettings& settings) {
    const int on_virtual = settings.virtual_repeats * settings.secondary;
    const int on_real = settings.estimator == Estimator::difference
                            ? change_counts(scene, settings).light
                            : settings.secondary;
    return settings.primary * std::max({on_virtual, on_real, 1});
}

/// The random numbers and rays of one tile.
struct TilePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const LightNets& nets;
    std::uint32_t frame;
    Tile& tile;

    SampleKeys keys(int sample) const {
        return sample_keys(tile.area, scene.lens, {settings.seed, frame, 0, std::uint32_t(sample)});
    }

    Landings land_at(int sample) const {
        const RayPacket rays = camera_rays(tile.area, scene.lens, scene.world_from_camera,
                                           pixel_shifts(keys(sample), position_in_pixel));
        tile.rays.primary += std::uint64_t(std::popcount(rays.active));
        static const EmbreeScene none;
        return land(scene.real, settings.virtual_seen ? scene.virtual_objects : none, rays,
                    tile.area.pixels, settings.depth_tolerance);
    }

    void add_samples(const Landings& landings, int first_sample) const {
        for (int s = 0; s < settings.secondary; ++s) {
            SamplePass pass{scene,     settings,  landings, keys(first_sample + s),
                            tile.sums, tile.rays, nets};
            add_direct(pass);
            add_indirect(pass);
            if (settings.glossy_seen) add_glossy(pass);
        }
    }

    /// Samples of what virtual geometry changes on real surfaces.
    void add_changes(const Landings& landings, int ray) const {
        SamplePass pass{scene, settings, landings, keys(ray), tile.sums, tile.rays, nets};
        add_change({pass, change_counts(scene, settings), ray});
    }

    /// Samples of E_R: more where virtual geometry was seen to change the light.
    void add_real_light(const Landings& landings, int ray) const {
        LaneCounts counts{};
        for_each_lane([&](std::size_t lane, const PixelSums& sums) {
            if (landings[lane].kind == LandingKind::real)
                counts[lane] = real_light_samples(scene, settings, sums.change);
        });
        const int most = *std::max_element(counts.begin(), counts.end());
        for (int s = 0; s < most; ++s) {
            Landings sampled;
            SampleKeys numbers = keys(ray);
            for (std::size_t lane = 0; lane < packet_width; ++lane) {
                if (s < counts[lane]) sampled[lane] = landings[lane];
                numbers[lane].sample = std::uint32_t(ray * counts[lane] + s);
            }
            SamplePass pass{scene, settings, sampled, numbers, tile.sums, tile.rays, nets};
            add_real_direct(pass, counts);
            add_real_indirect(pass);
        }
    }

    template <class Body>
    void for_each_lane(const Body& body) const {
        for (int lane = 0; lane < packet_width; ++lane)
            if (tile.area.has(lane)) body(std::size_t(lane), tile.sums[std::size_t(lane)]);
    }
};

/// The landings of one kind; the others count as nothing.
Landings only(LandingKind kind, const Landings& landings) {
    Landings result;
    for (std::size_t lane = 0; lane < packet_width; ++lane)
        if (landings[lane].kind == kind) result[lane] = landings[lane];
    return result;
}

bool any_landing(const Landings& landings) {
    return std::any_of(landings.begin(), landings.end(),
                       [](const Landing& landing) { return landing.kind != LandingKind::nothing; });
}

/// Light samples of what one camera ray of each pixel met, but for E_R where it is sampled for
/// itself. Each ray takes the sample numbers that follow those of the ray before it, so that a
/// pixel's samples are spread as one sequence.
void gather_light(const TilePass& pass, const Landings& landings, int ray) {
    const int first_sample = ray * pass.settings.secondary;
    if (pass.settings.estimator == Estimator::two_mode) {
        pass.add_samples(landings, first_sample);
        return;
    }
    pass.add_changes(landings, ray);
    const Landings on_virtual = only(LandingKind::on_virtual, landings);
    if (any_landing(on_virtual)) pass.add_samples(on_virtual, first_sample);
}

bool sees_virtual(const Tile& tile) {
    return std::any_of(tile.sums.begin(), tile.sums.end(),
                       [](const PixelSums& sums) { return sums.looks_virtual > 0; });
}

/// Looks again at a tile with virtual surfaces: their edges and textures need more camera rays than
/// the light on real surfaces does, and their light is sampled where some of these rays meet them.
/// A kind of surface that only the other rays meet gets light samples too.
void refine(const TilePass& pass) {
    const SamplingSettings& settings = pass.settings;
    const int lit = settings.primary * settings.virtual_repeats;
    Landings missed_real, missed_virtual;  // both kinds may be missed in one pixel
    for (int p = settings.primary; p < std::max(settings.coverage, lit); ++p) {
        const Landings landings = pass.land_at(p);
        pass.for_each_lane([&](std::size_t lane, PixelSums& sums) {
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
        if (any_landing(on_virtual)) pass.add_samples(on_virtual, p * settings.secondary);
    }
    for (const Landings* missed : {&missed_real, &missed_virtual})
        if (any_landing(*missed)) gather_light(pass, *missed, lit);
    if (settings.estimator == Estimator::difference && any_landing(missed_real))
        pass.add_real_light(missed_real, lit);
}

void sample_tile(const TilePass& pass) {
    const SamplingSettings& settings = pass.settings;
    const bool apart = settings.estimator == Estimator::difference;
    std::vector<Landings> seen;
    if (apart) seen.reserve(std::size_t(settings.primary));
    for (int p = 0; p < settings.primary; ++p) {
        const Landings landings = pass.land_at(p);
        if (apart) seen.push_back(landings);
        pass.for_each_lane([&](std::size_t lane, PixelSums& sums) {
            look(landings[lane], sums);
            if (landings[lane].kind != LandingKind::nothing) receive(landings[lane], sums);
        });
        gather_light(pass, landings, p);
    }
    for (std::size_t p = 0; p < seen.size(); ++p)  // once the whole change is known
        pass.add_real_light(seen[p], int(p));
    if (sees_virtual(pass.tile)) refine(pass);
}

void add(RayCounts& sum, const RayCounts& more) {
    sum.primary += more.primary;
    sum.virtual_shadow += more.virtual_shadow;
    sum.virtual_indirect += more.virtual_indirect;
    sum.real_shadow += more.real_shadow;
    sum.real_indirect += more.real_indirect;
}

}  // namespace

void validate(const SamplingSettings& s) {
    require(s.virtual_repeats >= 1, "trace.virtual_repeats must be positive", ExitCode::usage);
    require(s.light_tries >= 1, "trace.light_tries must be positive", ExitCode::usage);
    require(s.coverage >= 0, "trace.coverage must not be negative", ExitCode::usage);
    require(s.primary > 0 && s.secondary > 0, "trace.primary and trace.secondary must be positive",
            ExitCode::usage);
    for (const auto& [name, share] : {std::pair{"trace.depth_tolerance", s.depth_tolerance},
                                      std::pair{"trace.occluder_floor", s.occluder_floor},
                                      std::pair{"trace.ignored_luminance", s.ignored_luminance}})
        require(share >= 0 && share <= 1, std::string(name) + " must lie within 0..1",
                ExitCode::usage);
}

SamplingSettings with_samples(SamplingSettings settings, int samples) {
    require(samples > 0 && (samples < 4 || samples % 4 == 0),
            "--samples " + std::to_string(samples) + ": expected 1, 2, 3 or a multiple of 4",
            ExitCode::usage);
    settings.primary = std::min(samples, 4);
    settings.secondary = samples / settings.primary;
    if (settings.coverage > 0) settings.coverage = std::max(settings.coverage, samples / 4);
    return settings;
}

TwoModeResult sample_two_modes(const TwoModeScene& scene, const SamplingSettings& settings,
                               std::uint32_t frame) {
    validate(settings);
    const Lens& lens = scene.lens;
    TwoModeResult result{make_noisy_layers(lens, scene.world_from_camera, settings), {}};
    result.layers.virtual_samples = result.layers.samples * settings.virtual_repeats;
    if (settings.unshadowed) {
        const Image<Rgb> black(lens.width, lens.height, Rgb(0));
        result.layers.unshadowed = {black, settings.virtual_seen ? black : Image<Rgb>{}};
    }
    const LightNets nets = make_light_nets(scene.environment, largest_net_use(scene, settings),
                                           {settings.seed, frame, 0, 0});
    const int rows = tile_rows(lens);
    std::vector<RayCounts> row_rays{std::size_t(rows)};
    std::vector<std::uint64_t> row_dropped(std::size_t(rows), 0);
    parallel_for(rows, [&](int row) {
        for (int column = 0; column < tile_columns(lens); ++column) {
            Tile tile;
            tile.area = tile_at(lens, column, row);
            sample_tile({scene, settings, nets, frame, tile});
            add(row_rays[std::size_t(row)], tile.rays);
            for (int lane = 0; lane < packet_width; ++lane) {
                if (!tile.area.has(lane)) continue;
                const auto i = std::size_t(lane);
                store(tile.sums[i], tile.area.pixels[i].x, tile.area.pixels[i].y, result.layers);
                row_dropped[std::size_t(row)] += std::uint64_t(dropped(tile.sums[i]));
            }
        }
    });
    for (std::size_t row = 0; row < row_rays.size(); ++row) {
        add(result.rays, row_rays[row]);
        result.layers.dropped_samples += row_dropped[row];
    }
    return result;
}

}  // namespace inlay
