#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/trace/light_estimators.h"
#include "render/trace/pixel_tile.h"

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

void count_landings(const Landings& landings, Tile& tile) {
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!tile.area.has(lane)) continue;
        const Landing& landing = landings[std::size_t(lane)];
        PixelSums& sums = tile.sums[std::size_t(lane)];
        ++sums.primary;
        if (landing.kind == LandingKind::nothing) continue;
        ReceiverSums& receiver = receiver_of(sums, landing.kind);
        if (receiver.hits++ == 0) receiver.object = landing.object;
        receiver.position += glm::dvec3(landing.position);
        receiver.normal += glm::dvec3(landing.normal);
        if (landing.kind != LandingKind::on_virtual) continue;
        sums.albedo.add(landing.bsdf.diffuse);
        sums.glossy_bandwidth = std::max(sums.glossy_bandwidth, glossy_bandwidth(landing.bsdf));
    }
}

void sample_tile(const TwoModeScene& scene, const SamplingSettings& settings, std::uint32_t frame,
                 Tile& tile) {
    const auto keys_of = [&](int sample) {
        return sample_keys(tile.area, scene.lens, {settings.seed, frame, 0, std::uint32_t(sample)});
    };
    for (int p = 0; p < settings.primary; ++p) {
        const RayPacket rays = camera_rays(tile.area, scene.lens, scene.world_from_camera,
                                           pixel_shifts(keys_of(p), position_in_pixel));
        const Landings landings = land(scene.real, scene.virtual_objects, rays, tile.area.pixels,
                                       settings.depth_tolerance);
        tile.rays.primary += std::uint64_t(std::popcount(rays.active));
        count_landings(landings, tile);
        for (int s = 0; s < settings.secondary; ++s) {
            SamplePass pass{scene,     settings, landings, keys_of(p * settings.secondary + s),
                            tile.sums, tile.rays};
            add_direct(pass);
            add_indirect(pass);
            add_glossy(pass);
        }
    }
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
    return settings;
}

TwoModeResult sample_two_modes(const TwoModeScene& scene, const SamplingSettings& settings,
                               std::uint32_t frame) {
    validate(settings);
    const Lens& lens = scene.lens;
    TwoModeResult result{
        make_noisy_layers(lens, scene.world_from_camera, settings.primary * settings.secondary),
        {}};
    if (settings.unshadowed) {
        const Image<Rgb> black(lens.width, lens.height, Rgb(0));
        result.layers.unshadowed = {black, black};
    }
    const int rows = tile_rows(lens);
    std::vector<RayCounts> row_rays{std::size_t(rows)};
    std::vector<std::uint64_t> row_dropped(std::size_t(rows), 0);
    parallel_for(rows, [&](int row) {
        for (int column = 0; column < tile_columns(lens); ++column) {
            Tile tile;
            tile.area = tile_at(lens, column, row);
            sample_tile(scene, settings, frame, tile);
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
