// Where E_R is needed at all: the composite shows it only where the change beside it is not 0, and
// the filter reads it from there as far as its kernels reach.
#pragma once

#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"

#include <cstdint>

namespace inlay {

/// Not 0 at the pixels whose E_R has a part in the composite. `touched` says where virtual geometry
/// changes light on real surfaces, or may; `now` is sampled but for E_R. `previous` (null: none) is
/// the frame before, with which only the change is filtered. If both modes share their samples, the
/// next frame's filter reads all of this one: with settings.temporal all is needed.
Image<std::uint8_t> light_demand(const Image<std::uint8_t>& touched, const NoisyLayers& now,
                                 const NoisyLayers* previous, const FilterSettings& settings);

}  // namespace inlay
