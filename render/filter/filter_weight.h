// The weights of pairs of pixels, a run of them at a time.
#pragma once

#include "render/filter/axis_aligned_filter.h"

#include <cstddef>
#include <cstdint>

namespace inlay {

/// A run of pixels of one row; `precision` is that of the axis at hand.
struct PixelRun {
    const float* position[3];
    const float* normal[3];
    const float* precision;
    const std::uint32_t* object;
};

inline PixelRun pixel_run(const FilterPlanes& planes, const Image<float>& precision, int x, int y) {
    const SurfacePlanes& s = *planes.surface;
    const std::size_t at = planes.object.index(x, y);
    return {{s.position[0].pixels.data() + at, s.position[1].pixels.data() + at,
             s.position[2].pixels.data() + at},
            {s.normal[0].pixels.data() + at, s.normal[1].pixels.data() + at,
             s.normal[2].pixels.data() + at},
            precision.pixels.data() + at,
            planes.object.pixels.data() + at};
}

/// weights[k] = the weight of a's and b's pixel k (see filter_axis_aligned), for k < count.
void weigh(const PixelRun& a, const PixelRun& b, int count, float normal_cosine,
           float* __restrict weights);

}  // namespace inlay
