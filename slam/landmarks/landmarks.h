// Landmarks: points of a view that later views may know again by their looks.
#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace inlay {

/// 256 comparisons of brightness around a corner; alike where few bits differ (Rublee et al. 2011).
using LandmarkDescriptor = std::array<std::uint8_t, 32>;

/// Bits in which descriptors of one corner may differ; unrelated ones differ in some 128.
constexpr int most_different_bits = 64;

/// All vectors run in parallel. Ordered so that every run from the start is spread over the image.
struct Landmarks {
    std::vector<glm::vec2> pixel;     // px of the color image
    std::vector<glm::vec3> position;  // m, camera frame
    std::vector<LandmarkDescriptor> descriptor;
};

}  // namespace inlay
