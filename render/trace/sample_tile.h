// All that the pixels of a tile see, and the light there.
#pragma once

#include "render/trace/tile_pass.h"

namespace inlay {

/// Camera rays of a pixel in a tile that sees virtual surfaces.
int most_camera_rays(const SamplingSettings& settings);

/// Environment samples that one estimator of a pixel takes one after the other.
int largest_net_use(const TwoModeScene& scene, const SamplingSettings& settings);

/// Samples a tile, but E_R where it is sampled for itself. `needed` are the pixels whose real
/// surfaces need light samples.
void sample_tile(const TilePass& pass, std::uint32_t needed);

/// The pixels of which a light sample on a real surface may meet virtual geometry, if both modes
/// share their samples; all of a tile that sees virtual surfaces.
std::uint32_t touched_lanes(const TilePass& pass);

}  // namespace inlay
