// A Gaussian blur that knows which pixels count: normalised convolution.
#pragma once

#include "recordings/base/image.h"

#include <cstdint>
#include <vector>

namespace inlay {

/// Each channel as sum(w v) / sum(w) over the pixels with an object, w = exp(-d^2 / (2 sigma^2)) up
/// to 3 sigma (px) along rows and columns (Knutsson and Westin 1993, with certainty 0 or 1); 0
/// where there is no object. Separable and exact: rows carry their sum of weights along. Sums are
/// in double precision, so that a constant comes back to the bit. `sigma` > 0.
void blur_masked(const Image<std::uint32_t>& object, double sigma,
                 std::vector<Image<float>>& channels);

}  // namespace inlay
