// The weights of pairs of pixels, a run of them at a time.
#pragma once

#include "render/filter/axis_aligned_filter.h"

#include <algorithm>
#include <bit>
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

/// exp(-x) for x >= 0 within 2e-7 relative, exactly 1 at 0, and e^-60 beyond 60 (nothing, in a mean
/// that holds its own pixel with weight 1) where `keep` is 1; 0 where it is 0. No branch: bits are
/// masked, and numbers that are not negative compare as their bits do.
inline float exp_minus(float x, std::int32_t keep) {
    const std::int32_t bounded =
        std::min(std::bit_cast<std::int32_t>(x), std::bit_cast<std::int32_t>(60.0f));
    const float power = std::bit_cast<float>(bounded) * -1.44269504f;
    const auto whole = static_cast<std::int32_t>(power - 0.5f);
    const float f = power - static_cast<float>(whole);  // -0.5 .. 0.5; Taylor series of 2^f
    const float mantissa =
        1.0f + f * (0.693147181f +
                    f * (0.240226507f +
                         f * (0.0555041087f +
                              f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
    const std::int32_t bits = std::bit_cast<std::int32_t>(mantissa) + whole * (1 << 23);
    return std::bit_cast<float>(bits & -keep);
}

/// weights[k] = the weight of a's and b's pixel k (see filter_axis_aligned), for k < count.
void weigh(const PixelRun& a, const PixelRun& b, int count, float normal_cosine,
           float* __restrict weights);

}  // namespace inlay
