// Separable convolution with the borders that image metrics ask for.
#pragma once

#include "recordings/base/image.h"

#include <vector>

namespace inlay {

/// Weights for the offsets -r .. r, in this order.
using Kernel = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) for |x| <= radius (px), not normalised; sigma > 0.
Kernel gaussian_kernel(double sigma, int radius);

/// The kernel divided by its sum.
Kernel normalised(Kernel kernel);

/// Convolves rows with `across` and columns with `down`; pixels beyond the border repeat the last
/// one inside.
Image<double> convolve(const Image<double>& image, const Kernel& across, const Kernel& down);

}  // namespace inlay
