// E_R for itself: light on real surfaces from real geometry alone.
#pragma once

#include "render/trace/light_need.h"
#include "render/trace/tile_pass.h"

namespace inlay {

/// A number for each pixel of a tile.
using LaneCounts = std::array<int, packet_width>;

/// The largest number of samples that E_R gets in a pixel, where it is sampled for itself.
int most_real_light_samples(const SamplingSettings& settings);

/// One sample of E_R, direct and indirect, where `pass` lands on real surfaces; `counts` are the
/// samples that each pixel takes in all.
void add_real_light(SamplePass& pass, const LaneCounts& counts);

/// E_R of a tile's pixels that are `chosen`, after all else was sampled (`layers`): as many samples
/// as its need says, spread evenly over settings.primary camera rays; those of rays that land
/// elsewhere are left out. Where none of these rays lands on a real surface, the next one that does
/// stands for the first of them.
void light_real_surfaces(const TilePass& pass, std::uint32_t chosen, const NoisyLayers& layers,
                         const Image<LightNeed>& needs);

}  // namespace inlay
