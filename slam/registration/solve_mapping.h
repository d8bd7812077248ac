// The mapping under which the rims of depth images lie on edges of color images.
#pragma once

#include "slam/registration/match_edge.h"

#include <span>
#include <vector>

namespace inlay {

/// What one frame knows.
struct RimView {
    double time = 0;               // s
    std::vector<RimPoint> points;  // of the depth image's rims
    ColorEdges edges;              // of the color image
};

/// What a mapping is judged by.
struct RimViews {
    std::vector<RimView> views;
    Lens color_lens;
    std::vector<TimedCamera> trajectory;
};

/// Which parameters may move, besides the rotation.
struct MappingFreedom {
    bool translation = true, delay = true, log_focal = true, rim = true;
};

struct SolveStage {
    EdgeMatching matching;
    MappingFreedom free;
    int iterations = 10;  // at most
};

struct SolvedMapping {
    ColorMapping mapping;
    double cost = 1;  // 0..1, mean over the matched points; 0: every rim lies on an edge
};

/// Improves `start` for the frames numbered `chosen`: Gauss-Newton with Welsch weights
/// (Holland and Welsch 1977: exp(-(r/s)^2), here with s = sqrt(2) sigma) and mild priors about
/// "registered already", so that what the views do not show stays there.
SolvedMapping solve_mapping(const RimViews& problem, std::span<const int> chosen,
                            const ColorMapping& start, const SolveStage& stage);

/// How well rims of the chosen frames lie on edges: the mean of exp(-d^2 / (2 sigma^2)) over the
/// distances d (px) of those inside the image, 0..1.
double mapping_score(const RimViews& problem, std::span<const int> chosen,
                     const ColorMapping& mapping, double sigma);

/// Root mean square distance (px) between where two mappings put the outermost pixels of rims.
double mapping_shift(const RimViews& problem, ColorMapping a, ColorMapping b);

struct EdgeDistances {
    double mean = 0;  // px, distances capped at 10
    double near = 0;  // share of the points within 2 px
};

/// From the rims inside the image to the nearest edges of their direction.
EdgeDistances edge_distances(const RimViews& problem, const ColorMapping& mapping);

}  // namespace inlay
