// FramePass: a frame's tiles, in any order and on all threads, with what sampling them adds up to.
#pragma once

#include "recordings/base/parallel.h"
#include "render/trace/tile_pass.h"

#include <vector>

namespace inlay {

struct FramePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const LightNets& nets;
    std::uint32_t frame;
    TwoModeResult& result;

    /// body(pass, lanes) for every tile with its pixels that are `chosen` (empty: all), and then
    /// end(sums, pixel) for each of its pixels.
    template <class Body, class End>
    void over_tiles(const Image<std::uint8_t>& chosen, const Body& body, const End& end) const;

    /// The same, but what is not chosen is passed over.
    template <class Body, class End>
    void over_chosen(const Image<std::uint8_t>& chosen, const Body& body, const End& end) const;

private:
    template <class Body, class End>
    void over_lanes(const Image<std::uint8_t>& chosen, bool all, const Body& body,
                    const End& end) const;
};

template <class Body, class End>
void FramePass::over_tiles(const Image<std::uint8_t>& chosen, const Body& body,
                           const End& end) const {
    over_lanes(chosen, true, body, end);
}

template <class Body, class End>
void FramePass::over_chosen(const Image<std::uint8_t>& chosen, const Body& body,
                            const End& end) const {
    over_lanes(chosen, false, body, end);
}

template <class Body, class End>
void FramePass::over_lanes(const Image<std::uint8_t>& chosen, bool all, const Body& body,
                           const End& end) const {
    const int rows = tile_rows(scene.lens);
    std::vector<RayCounts> row_rays{std::size_t(rows)};
    std::vector<std::uint64_t> row_dropped(std::size_t(rows), 0);
    parallel_for(rows, [&](int row) {
        for (int column = 0; column < tile_columns(scene.lens); ++column) {
            const PixelTile area = tile_at(scene.lens, column, row);
            const std::uint32_t lanes = lanes_of(area, chosen);
            if (!all && lanes == 0) continue;
            Tile tile = make_tile(area, scene.lens, settings, frame);
            body(TilePass{scene, settings, nets, tile}, lanes);
            row_rays[std::size_t(row)] += tile.rays;
            for_each_lane(tile, [&](std::size_t lane, const PixelSums& sums) {
                if (!all && !((lanes >> lane) & 1U)) return;
                end(sums, tile.area.pixels[lane]);
                row_dropped[std::size_t(row)] += std::uint64_t(dropped(sums));
            });
        }
    });
    for (std::size_t row = 0; row < row_rays.size(); ++row) {
        result.rays += row_rays[row];
        result.layers.dropped_samples += row_dropped[row];
    }
}

}  // namespace inlay
