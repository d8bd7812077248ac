// Weighted means over any neighborhood: what every edge-stopping baseline is made of.
#pragma once

#include "render/filter/axis_aligned_filter.h"

#include <functional>
#include <span>
#include <vector>

namespace inlay {

/// A neighbor (px away, not the pixel itself), and the exponent of its weight exp(-exponent), >= 0.
struct Tap {
    int dx = 0, dy = 0;
    float exponent = 0;
};

/// `count` pixels of row y from x on, each paired with the one (tap.dx, tap.dy) away.
struct PairRun {
    int x = 0, y = 0, count = 0;
    Tap tap;
};

/// Adds to the exponent (>= 0) of each pair of a run. Called from several threads.
using AddExponents = std::function<void(const PairRun& run, float* exponents)>;

struct Means {
    std::vector<Image<float>> channels;
    Image<float> variance;  // of a mean of independent values with the variances given
};

/// Sum w v / sum w over the pixel itself (w = 1) and its taps; other objects and pixels without one
/// have no weight. Values are added as differences to the pixel's own, so that constants stay the
/// same to the bit. `variance` may be null. 0 where there is no object.
Means weighted_means(const Image<std::uint32_t>& object, const std::vector<Image<float>>& channels,
                     const Image<float>* variance, std::span<const Tap> taps,
                     const AddExponents& add_exponents);

/// The square of `radius` px around a pixel, with the exponents of a Gaussian of `sigma` px;
/// infinite sigma: all 0.
std::vector<Tap> gaussian_taps(int radius, double sigma);

}  // namespace inlay
