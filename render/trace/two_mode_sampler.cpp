#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/trace/change_estimator.h"
#include "render/trace/light_estimators.h"
#include "render/trace/real_light.h"
#include "render/trace/tile_pass.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

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

/// Environment samples that one estimator of a pixel takes one after the other.
int largest_net_use(const TwoModeScene& scene, const SamplingSettings& settings) {
    const int on_virtual = settings.virtual_repeats * settings.secondary;
    const int on_real = settings.estimator == Estimator::difference
                            ? change_counts(scene, settings).light
                            : settings.secondary;
    return settings.primary * std::max({on_virtual, on_real, 1});
}

template <class Body>
void for_each_lane(Tile& tile, const Body& body) {
    for (int lane = 0; lane < packet_width; ++lane)
        if (tile.area.has(lane)) body(std::size_t(lane), tile.sums[std::size_t(lane)]);
}

void add_samples(const TilePass& pass, const Landings& landings, int first_sample) {
    for (int s = 0; s < pass.settings.secondary; ++s) {
        SamplePass sample = pass.from(landings, pass.keys(first_sample + s));
        add_direct(sample);
        add_indirect(sample);
        if (pass.settings.glossy_seen) add_glossy(sample);
    }
}

/// Light samples of what one camera ray of each pixel met, but for E_R where it is sampled for
/// itself. Each ray takes the sample numbers that follow those of the ray before it, so that a
/// pixel's samples are spread as one sequence.
void gather_light(const TilePass& pass, const Landings& landings, int ray) {
    const int first_sample = ray * pass.settings.secondary;
    if (pass.settings.estimator == Estimator::two_mode) {
        add_samples(pass, landings, first_sample);
        return;
    }
    SamplePass sample = pass.from(landings, pass.keys(ray));
    add_change({sample, change_counts(pass.scene, pass.settings), ray});
    const Landings on_virtual = only(LandingKind::on_virtual, landings);
    if (any_landing(on_virtual)) add_samples(pass, on_virtual, first_sample);
}

bool sees_virtual(const Tile& tile) {
    return std::any_of(tile.sums.begin(), tile.sums.end(),
                       [](const PixelSums& sums) { return sums.looks_virtual > 0; });
}

/// Camera rays of a pixel in a tile that sees virtual surfaces.
int most_camera_rays(const SamplingSettings& settings) {
    return std::max(settings.coverage, settings.primary * settings.virtual_repeats);
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
        if (any_landing(missed)) gather_light(pass, missed, lit);
}

/// All that a tile's pixels see, with its light; but E_R where it is sampled for itself. `needed`
/// are the pixels whose real surfaces need light samples.
void sample_tile(const TilePass& pass, std::uint32_t needed) {
    for (int p = 0; p < pass.settings.primary; ++p) {
        const Landings landings = pass.land_at(p);
        for_each_lane(pass.tile, [&](std::size_t lane, PixelSums& sums) {
            look(landings[lane], sums);
            if (landings[lane].kind != LandingKind::nothing) receive(landings[lane], sums);
        });
        gather_light(pass, where_needed(landings, needed), p);
    }
    if (sees_virtual(pass.tile)) refine(pass, needed);
}

/// The pixels of which a light sample on a real surface may meet virtual geometry, if both modes
/// share their samples; all of a tile that sees virtual surfaces.
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

/// Samples of E_R: more where virtual geometry was seen to change the light.
void light_real_surfaces(const TilePass& pass, std::uint32_t needed, const NoisyLayers& layers) {
    LaneCounts counts{};
    for_each_lane(pass.tile, [&](std::size_t lane, const PixelSums&) {
        const glm::ivec2 p = pass.tile.area.pixels[lane];
        const std::size_t at = layers.m.index(p.x, p.y);
        if (layers.real.object.pixels[at] == 0 || !((needed >> lane) & 1U)) return;
        counts[lane] =
            real_light_samples(pass.scene, pass.settings, layers.change_rates.share.pixels[at],
                               layers.direct.e_rv_real.pixels[at]);
    });
    sample_real_light(pass, counts, most_camera_rays(pass.settings));
}

void add(RayCounts& sum, const RayCounts& more) {
    sum.primary += more.primary;
    sum.virtual_shadow += more.virtual_shadow;
    sum.virtual_indirect += more.virtual_indirect;
    sum.real_shadow += more.real_shadow;
    sum.real_indirect += more.real_indirect;
}

/// A frame's tiles, and what sampling them adds up to.
struct FramePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const LightNets& nets;
    std::uint32_t frame;
    TwoModeResult& result;

    /// body(pass, needed) for every tile, and then end(sums, x, y) for each of its pixels; `needed`
    /// (empty: all) is asked for the tile's lanes.
    template <class Body, class End>
    void over_tiles(const Image<std::uint8_t>& needed, const Body& body, const End& end) const;
};

std::uint32_t lanes_of(const PixelTile& area, const Image<std::uint8_t>& chosen) {
    if (chosen.empty()) return area.inside;
    std::uint32_t lanes = 0;
    for (int lane = 0; lane < packet_width; ++lane) {
        const glm::ivec2 p = area.pixels[std::size_t(lane)];
        if (area.has(lane) && chosen(p.x, p.y) != 0) lanes |= 1U << lane;
    }
    return lanes;
}

template <class Body, class End>
void FramePass::over_tiles(const Image<std::uint8_t>& needed, const Body& body,
                           const End& end) const {
    const int rows = tile_rows(scene.lens);
    std::vector<RayCounts> row_rays{std::size_t(rows)};
    std::vector<std::uint64_t> row_dropped(std::size_t(rows), 0);
    parallel_for(rows, [&](int row) {
        for (int column = 0; column < tile_columns(scene.lens); ++column) {
            Tile tile;
            tile.area = tile_at(scene.lens, column, row);
            body(TilePass{scene, settings, nets, frame, tile}, lanes_of(tile.area, needed));
            add(row_rays[std::size_t(row)], tile.rays);
            for_each_lane(tile, [&](std::size_t lane, const PixelSums& sums) {
                end(sums, tile.area.pixels[lane]);
                row_dropped[std::size_t(row)] += std::uint64_t(dropped(sums));
            });
        }
    });
    for (std::size_t row = 0; row < row_rays.size(); ++row) {
        add(result.rays, row_rays[row]);
        result.layers.dropped_samples += row_dropped[row];
    }
}

/// Whether light samples meet virtual geometry in most parts of the image: one tile of 64 tells.
bool touched_all_over(const FramePass& pass) {
    constexpr int step = 8;
    int asked = 0, touched = 0;
    for (int row = step / 2; row < tile_rows(pass.scene.lens); row += step) {
        for (int column = step / 2; column < tile_columns(pass.scene.lens); column += step) {
            Tile tile;
            tile.area = tile_at(pass.scene.lens, column, row);
            ++asked;
            touched += touched_lanes({pass.scene, pass.settings, pass.nets, pass.frame, tile}) != 0;
            add(pass.result.rays, tile.rays);
        }
    }
    return touched > asked / 2;
}

/// 1 where virtual geometry is met by light samples that both modes share, or may be: everywhere,
/// where to find out would cost more than it can save.
Image<std::uint8_t> touched_pixels(const FramePass& pass) {
    Image<std::uint8_t> touched(pass.scene.lens.width, pass.scene.lens.height, 0);
    if (touched_all_over(pass)) {
        std::fill(touched.pixels.begin(), touched.pixels.end(), std::uint8_t(1));
        return touched;
    }
    const auto nothing_more = [](const PixelSums&, glm::ivec2) {};
    pass.over_tiles(
        {},
        [&](const TilePass& tile, std::uint32_t) {
            const std::uint32_t lanes = touched_lanes(tile);
            for (int lane = 0; lane < packet_width; ++lane)
                if ((lanes >> lane) & 1U) {
                    const glm::ivec2 p = tile.tile.area.pixels[std::size_t(lane)];
                    touched(p.x, p.y) = 1;
                }
        },
        nothing_more);
    return touched;
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
                               std::uint32_t frame, const LightDemand& demand) {
    validate(settings);
    const Lens& lens = scene.lens;
    TwoModeResult result{make_noisy_layers(lens, scene.world_from_camera, settings), {}};
    NoisyLayers& layers = result.layers;
    layers.virtual_samples = layers.samples * settings.virtual_repeats;
    if (settings.unshadowed) {
        const Image<Rgb> black(lens.width, lens.height, Rgb(0));
        layers.unshadowed = {black, settings.virtual_seen ? black : Image<Rgb>{}};
    }
    const LightNets nets = make_light_nets(scene.environment, largest_net_use(scene, settings),
                                           {settings.seed, frame, 0, 0});
    const FramePass pass{scene, settings, nets, frame, result};
    const auto store_all = [&](const PixelSums& sums, glm::ivec2 p) {
        store(sums, p.x, p.y, layers);
    };
    if (settings.estimator == Estimator::two_mode) {
        if (demand) layers.sampled_real = demand(touched_pixels(pass), layers);
        pass.over_tiles(layers.sampled_real, sample_tile, store_all);
        return result;
    }
    pass.over_tiles({}, sample_tile, store_all);
    if (demand) layers.sampled_real = demand(changed_pixels(layers), layers);
    pass.over_tiles(
        layers.sampled_real,
        [&](const TilePass& tile, std::uint32_t needed) {
            light_real_surfaces(tile, needed, layers);
        },
        [&](const PixelSums& sums, glm::ivec2 p) { add_real_light(sums, p.x, p.y, layers); });
    return result;
}

}  // namespace inlay
