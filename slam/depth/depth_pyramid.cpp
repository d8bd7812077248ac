#include "slam/depth/depth_pyramid.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace inlay {
namespace {

Lens halved(const Lens& lens) {
    Lens result = lens;
    result.width = lens.width / 2;
    result.height = lens.height / 2;
    result.fx = lens.fx / 2;
    result.fy = lens.fy / 2;
    result.cx = (lens.cx + 0.5) / 2 - 0.5;
    result.cy = (lens.cy + 0.5) / 2 - 0.5;
    return result;
}

float block_depth(const Image<float>& fine, int x, int y, const DepthSettings& settings) {
    const std::array<float, 4> block{fine(2 * x, 2 * y), fine(2 * x + 1, 2 * y),
                                     fine(2 * x, 2 * y + 1), fine(2 * x + 1, 2 * y + 1)};
    float nearest = 0;
    for (const float z : block) {
        if (z > 0 && (nearest == 0 || z < nearest)) nearest = z;
    }
    if (nearest == 0) return 0;
    float sum = 0;
    int count = 0;
    for (const float z : block) {
        if (z == 0 || z - nearest > depth_step(nearest, settings)) continue;
        sum += z;
        ++count;
    }
    return sum / float(count);
}

}  // namespace

DepthLevel halve(const DepthLevel& fine, const DepthSettings& settings) {
    DepthLevel coarse{{}, halved(fine.lens)};
    coarse.depth = Image<float>(coarse.lens.width, coarse.lens.height);
    parallel_rows(coarse.lens.height, [&](int y) {
        for (int x = 0; x < coarse.lens.width; ++x) {
            coarse.depth(x, y) = block_depth(fine.depth, x, y, settings);
        }
    });
    return coarse;
}

std::vector<DepthLevel> depth_pyramid(const Image<float>& depth, const Lens& lens, int levels,
                                      const DepthSettings& settings) {
    std::vector<DepthLevel> pyramid{{depth, lens}};
    while (int(pyramid.size()) < levels)
        pyramid.push_back(halve(pyramid.back(), settings));
    return pyramid;
}

}  // namespace inlay
