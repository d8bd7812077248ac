// Where the depth of a surface map cannot be trusted to the pixel: beside depth steps and holes.
#pragma once

#include "recordings/base/surface_map.h"

#include <cstdint>

namespace inlay {

constexpr int widest_band = 8;  // px

/// How far from an edge depth is not trusted: by `reach` (m, across the nearer surface), 1 to 8 px;
/// and by up to 2.5 times that, but then no more than `smear` px.
struct BandWidth {
    float reach = 0;
    int smear = 0;
};

/// The half-width (px) of the band that a pixel is in, near a depth step or a hole; 0 elsewhere. A
/// step is a neighbour that lies off the plane of a pixel by more than `step` of its depth, and the
/// other way round.
Image<std::uint8_t> edge_band(const SurfaceMap& map, const BandWidth& width, float step);

}  // namespace inlay
