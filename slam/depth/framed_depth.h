// A depth image in a frame of holes, so that windows and rows of eight pixels need no bounds.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lanes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace inlay {

struct FramedDepth {
    int margin = 0;  // px on each side, and a register's more on the right
    Image<float> depth;

    /// Pixels (x, y) to (x + 7, y) of the image within the frame; x and y may be up to `margin`
    /// outside of it.
    Floats eight(int x, int y) const {
        return Floats(&depth.pixels[depth.index(x + margin, y + margin)], stdx::element_aligned);
    }
};

/// What is not a finite number becomes a hole.
inline FramedDepth framed(const Image<float>& depth, int margin) {
    FramedDepth result{margin, Image<float>(depth.width + 2 * margin + lane_count,
                                            depth.height + 2 * margin, 0.0f)};
    for (int y = 0; y < depth.height; ++y) {
        const auto row = depth.pixels.begin() + std::ptrdiff_t(depth.index(0, y));
        const auto place = std::ptrdiff_t(result.depth.index(margin, y + margin));
        std::transform(row, row + depth.width, result.depth.pixels.begin() + place,
                       [](float z) { return std::isfinite(z) ? z : 0.0f; });
    }
    return result;
}

}  // namespace inlay
