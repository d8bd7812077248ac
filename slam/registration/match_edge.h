// How far a seen rim is from the edge of the color image that belongs to it.
#pragma once

#include "slam/registration/color_edges.h"
#include "slam/registration/color_mapping.h"

#include <optional>

namespace inlay {

/// Which edge belongs to a rim.
enum class EdgeChoice {
    nearest,  // the nearest one of its direction: a wide basin
    crossed   // the most distinct one along its normal: exact
};

struct EdgeMatching {
    EdgeChoice choice = EdgeChoice::nearest;
    double sigma = 5;  // px, 5 at most for `crossed`: how far edges are expected
};

struct EdgeMatch {
    double distance = 0;      // px; signed for `crossed`
    glm::dvec2 direction{0};  // how it changes with the rim's position
};

/// Empty where the rim is outside the image or too close to its border, and for `crossed` where
/// there is no edge within 3 sigma.
std::optional<EdgeMatch> match_edge(const ColorEdges& edges, const SeenRim& rim,
                                    const EdgeMatching& matching);

}  // namespace inlay
