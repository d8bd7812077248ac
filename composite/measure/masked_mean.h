// Means over the pixels that a mask counts, and the checks that come before.
#pragma once

#include "composite/measure/image_error.h"
#include "recordings/base/check.h"
#include "recordings/base/image.h"

#include <cstddef>
#include <string>

namespace inlay {

inline bool counts(const Mask& mask, std::size_t i) { return mask.empty() || mask.pixels[i] != 0; }

/// Throws Error (bad_data) unless both pictures and the mask have one size, of at least one pixel.
template <class Pixel>
void check_comparable(const Image<Pixel>& image, const Image<Pixel>& reference,
                      const Mask& mask = {}) {
    const auto size = [](const auto& i) {
        return std::to_string(i.width) + " x " + std::to_string(i.height) + " px";
    };
    require(same_size(image, reference), "sizes differ: " + size(image) + " against " +
                                             size(reference) + "; only equal sizes are compared");
    require(!image.empty(), "an empty picture cannot be compared");
    require(mask.empty() || same_size(image, mask),
            "the mask is " + size(mask) + ", the pictures " + size(image));
}

/// Mean of value(i) over the counted pixel numbers; throws Error (bad_data) when none is counted.
template <class Pixel, class Value>
double masked_mean(const Image<Pixel>& image, const Mask& mask, Value value) {
    double sum = 0;
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (!counts(mask, i)) continue;
        sum += value(i);
        ++pixels;
    }
    require(pixels > 0, "the mask counts no pixel");
    return sum / double(pixels);
}

}  // namespace inlay
