// E_R for itself: light on real surfaces from real geometry alone.
#pragma once

#include "render/trace/tile_pass.h"

namespace inlay {

/// A number for each pixel of a tile.
using LaneCounts = std::array<int, packet_width>;

/// Samples of E_R, where it is sampled for itself, in a pixel of which virtual surfaces hide the
/// share `hidden` of an even sky, and whose direct light changes by `change`: as many as of other
/// light if that is plainly seen, since the ratio to E_R is shown there; a quarter if it is slight;
/// else a sixteenth, for the neighbours to filter with. One at least. What virtual surfaces are
/// made of does not matter.
int real_light_samples(const TwoModeScene& scene, const SamplingSettings& settings, float hidden,
                       const Rgb& change);
/// The largest number that it gives, per pixel.
int most_real_light_samples(const SamplingSettings& settings);

/// Samples E_R from the camera rays of each pixel that land on real surfaces, `counts` samples
/// (0: none) spread evenly over settings.primary rays; those of rays that land elsewhere are left
/// out. Where none of these rays lands on a real surface, the next one that does, of `camera_rays`
/// in all, stands for the first of them.
void sample_real_light(const TilePass& pass, const LaneCounts& counts, int camera_rays);

}  // namespace inlay
