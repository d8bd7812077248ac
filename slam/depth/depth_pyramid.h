// Halved levels of a depth image that keep "not measured".
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "slam/depth/filter_depth.h"

#include <vector>

namespace inlay {

struct DepthLevel {
    Image<float> depth;  // m, 0 = not measured
    Lens lens;
};

/// Half the size: the mean of each 2 x 2 block over those of its pixels that lie on the surface of
/// its nearest one; 0 where no pixel of the block was measured. An odd last row or column is
/// dropped, so the lens is halved exactly.
DepthLevel halve(const DepthLevel& fine, const DepthSettings& settings);

/// `levels` >= 1 levels; [0] is the given one.
std::vector<DepthLevel> depth_pyramid(const Image<float>& depth, const Lens& lens, int levels,
                                      const DepthSettings& settings);

}  // namespace inlay
