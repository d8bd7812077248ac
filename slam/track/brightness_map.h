// A photograph as tracking sees it: how bright its pixels are, and where that changes.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/lens.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace inlay {

struct Brightness {
    float value = 0;     // square root of the linear luminance; 0: not known
    glm::vec2 slope{0};  // of the value, per unit of the ray's x and y at z = 1
};

struct BrightnessMap {
    Lens lens;
    Image<Brightness> pixels;
};

/// One map for each of `lenses`, each half as large as the one before: the photograph's luminance,
/// averaged over blocks of 2 x 2 px until it has the lens's size, then smoothed over 3 x 3 px. The
/// square root makes the noise of light and of 8-bit sRGB about the same everywhere, and keeps a
/// change of exposure one factor. Black pixels are not known; neither is what they touch. An odd
/// last row or column is dropped, as depth_pyramid() does.
std::vector<BrightnessMap> brightness_pyramid(const Image<EncodedRgb>& photograph,
                                              std::span<const Lens> lenses);

/// Between the pixels, bilinearly; value 0 where one of the four around it is not known.
Brightness brightness_at(const BrightnessMap& map, const glm::vec2& position);

}  // namespace inlay
