// Where the depth of a surface map cannot be trusted to the pixel: beside depth steps and holes.
#pragma once

#include "recordings/base/surface_map.h"

#include <cstdint>

namespace inlay {

/// The half-width (px) of the band that a pixel is in: those within `reach` (m, across the nearer
/// surface; 1 to 8 px) of a depth step or of a hole; 0 elsewhere. A step is a neighbour that lies
/// off the plane of a pixel by more than `step` of its depth, and the other way round.
Image<std::uint8_t> edge_band(const SurfaceMap& map, float reach, float step);

}  // namespace inlay
