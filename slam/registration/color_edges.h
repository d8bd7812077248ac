// Where a color image has edges: how far they are, and how color changes.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace inlay {

constexpr int edge_directions = 4;         // classes of an edge's normal, over half a turn
constexpr double farthest_edge = 31;       // px; greater distances are not told apart
constexpr double edge_distance_steps = 8;  // units of ColorEdges::distance per px

struct ColorEdges {
    /// Of the smoothed encoded color (0..255), per px, in the channel that changes most.
    Image<glm::vec2> gradient;
    /// Distance to the nearest edge whose normal is of this class or one beside it, in 1/8 px, no
    /// more than farthest_edge.
    std::array<Image<std::uint8_t>, edge_directions> distance;
};

/// The class, 0..edge_directions - 1, of a normal and of its opposite.
int edge_direction(double x, double y);

/// Edges are ridges of the gradient's length (Canny 1986, Sec. VI: maxima along its direction) that
/// belong to the strongest quarter of the image and are 8 px long or more.
ColorEdges color_edges(const Image<EncodedRgb>& color);

}  // namespace inlay
