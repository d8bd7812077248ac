// The separable image-space filter with a width per pixel and axis: Mehta 2015, eqs. 6.21-6.26.
#pragma once

#include "recordings/base/image.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace inlay {

/// Positions and normals, one plane per coordinate, so that a row is a run of numbers.
struct SurfacePlanes {
    std::array<Image<float>, 3> position;  // m, world, each coordinate within +-1e9
    std::array<Image<float>, 3> normal;    // unit, world
};

/// What one run of the filter smooths, and what decides its weights. All images have one size, and
/// all values are finite; where `object` is 0 the channels are 0.
struct FilterPlanes {
    std::shared_ptr<const SurfacePlanes> surface;
    Image<std::uint32_t> object;  // 0: nothing here; pixels of different objects do not mix
    Image<float> precision_x, precision_y;  // 1 / sigma^2 along rows and columns (1/m^2), 0 .. 1e18
    std::vector<Image<float>> channels;     // all smoothed with the same weights
};

struct KernelSettings {
    int radius = 15;                    // px, each way along a row and a column
    float normal_cosine = 0.98480775f;  // > 0; normals that turn further do not mix
};

/// The channels of `now`, smoothed along rows, then along columns; 0 where there is no object.
/// The weight of two pixels is 0 unless they see the same object and normals within the stop, else
/// exp(-d^2 (precision + precision') / 4), which is eq. 6.23 with the mean square bandwidth.
/// `previous` (or null) is the previous frame resampled to this frame's pixels; its object is 0
/// where nothing fits. Both frames share one normalisation, sum (w E + w' E') / sum (w + w'): eq.
/// 6.26 is printed with a part of the fraction within the numerator. A row of the previous frame
/// that is only partly there counts for what is there.
/// Values are added as differences to the pixel's own, so that a constant stays the same to the
/// bit, and channels of the same bits get the same bits.
std::vector<Image<float>> filter_axis_aligned(FilterPlanes now, const FilterPlanes* previous,
                                              const KernelSettings& kernel);

}  // namespace inlay
