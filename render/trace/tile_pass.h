// TilePass: 16 pixels of a frame while they are sampled, with what all their samples share.
#pragma once

#include "render/trace/pixel_tile.h"
#include "render/trace/sample_pass.h"

namespace inlay {

/// A tile's random numbers, and what its samples add up to.
struct Tile {
    PixelTile area;
    SampleKeys keys;                                   // of its pixels' samples 0
    std::array<StratifiedSet, packet_width> in_pixel;  // where their camera rays pass
    LightRuns runs;
    std::array<PixelSums, packet_width> sums;
    RayCounts rays;
};

/// Sampling of one tile.
struct TilePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const LightNets& nets;
    Tile& tile;

    SampleKeys keys(int sample) const;

    /// Where camera ray `sample` of each pixel lands, of those in the bit mask `lanes`: the same
    /// whenever it is asked.
    Landings land_at(int sample, std::uint32_t lanes = ~0U) const;

    /// One sample from `landings`, which must outlive it.
    SamplePass from(const Landings& landings, const SampleKeys& keys) const;
};

/// A tile of the frame before its first sample.
Tile make_tile(const PixelTile& area, const Lens& lens, const SamplingSettings& settings,
               std::uint32_t frame);

/// body(lane, sums) for each pixel of the tile that lies in the image.
template <class Body>
void for_each_lane(Tile& tile, const Body& body) {
    for (int lane = 0; lane < packet_width; ++lane)
        if (tile.area.has(lane)) body(std::size_t(lane), tile.sums[std::size_t(lane)]);
}

/// The lanes whose pixels are chosen (not 0); an empty image chooses all.
std::uint32_t lanes_of(const PixelTile& area, const Image<std::uint8_t>& chosen);

/// The landings of one kind; the others count as nothing.
Landings only(LandingKind kind, const Landings& landings);

bool any_landing(const Landings& landings);

}  // namespace inlay
