// Normals of surfaces that were seen only a few times, steadied by their neighbors.
#pragma once

#include "recordings/base/surface_map.h"

namespace inlay {

struct NormalSmoothing {
    int radius = 3;              // px, of the square window
    float depth_step = 0.03f;    // share of depth within which neighbors belong to the same surface
    float crease_cosine = 0.5f;  // normals that turn further do not mix
};

/// Mixes each normal with the mean of its window, by the share of confidence that is missing: a
/// surface of full confidence keeps its normal. One frame's depth noise turns normals by more than
/// ten degrees, which would keep pixels of one plane from sharing their light.
Image<glm::vec3> smooth_normals(const SurfaceMap& surface, const NormalSmoothing& settings = {});

}  // namespace inlay
