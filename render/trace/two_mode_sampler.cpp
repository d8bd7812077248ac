#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "render/trace/frame_pass.h"
#include "render/trace/model_light.h"
#include "render/trace/real_light.h"
#include "render/trace/sample_tile.h"

#include <algorithm>
#include <string>
#include <utility>

namespace inlay {
namespace {

/// Whether light samples meet virtual geometry in most parts of the image: one tile of 64 tells.
bool touched_all_over(const FramePass& pass) {
    constexpr int step = 8;
    int asked = 0, touched = 0;
    for (int row = step / 2; row < tile_rows(pass.scene.lens); row += step) {
        for (int column = step / 2; column < tile_columns(pass.scene.lens); column += step) {
            Tile tile = make_tile(tile_at(pass.scene.lens, column, row), pass.scene.lens,
                                  pass.settings, pass.frame);
            ++asked;
            touched += touched_lanes({pass.scene, pass.settings, pass.nets, tile}) != 0;
            pass.result.rays += tile.rays;
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
    require(s.gathered >= 0, "trace.gathered must not be negative", ExitCode::usage);
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
    TwoModeResult result{make_noisy_layers(lens, scene.world_from_camera, settings), {}, {}};
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
    const Image<LightNeed> needs = light_needs(layers, scene.environment.mean_luminance);
    Image<std::uint8_t> left = layers.sampled_real;
    if (scene.model_light && takes_model_light(settings))
        left = light_from_model(*scene.model_light, left, needs, settings.occluder_floor, result);
    pass.over_chosen(
        left,
        [&](const TilePass& tile, std::uint32_t lanes) {
            light_real_surfaces(tile, lanes, layers, needs);
        },
        [&](const PixelSums& sums, glm::ivec2 p) { store_real_light(sums, p.x, p.y, layers); });
    return result;
}

}  // namespace inlay
