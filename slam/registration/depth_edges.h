// Where a depth image steps from a near surface to a far one.
#pragma once

#include "recordings/base/image.h"

#include <glm/glm.hpp>

#include <vector>

namespace inlay {

/// A point on the rim of a near surface, where a far one begins beside it.
struct DepthEdge {
    glm::ivec2 pixel{0};  // the outermost one on the near surface
    float depth = 0;      // m, the near surface's
    glm::vec2 normal{0};  // unit, in the image, towards the far surface
};

struct DepthEdgeSettings {
    float nearest = 0.2f;            // m, nearer rims are not used
    float farthest = 4.5f;           // m; farther ones are ragged
    float step = 0.04f;              // m, least step between the surfaces
    float relative_step = 0.03f;     // of the near depth, likewise; grows further beyond 1.5 m
    int hole = 4;                    // px without depth that may lie between the surfaces
    float shadow_baseline = 0.075f;  // m from camera to projector, whose shadow widens holes in a
                                     // row; 0: the sensor casts none
    int least_length = 20;           // px; shorter rims are noise
};

/// The rims of a depth image (m; 0, NaN and infinities are not measured) of a lens with this focal
/// length (px), row by row. Steps are looked for along rows and columns, the normal is the way in
/// which the smoothed inverse depth falls. The image's margin of 6 px has none.
std::vector<DepthEdge> depth_edges(const Image<float>& depth, double focal_length,
                                   const DepthEdgeSettings& settings);

}  // namespace inlay
