// Surfaces so steep that neighboring pixels differ like the two sides of an edge.
#pragma once

#include "recordings/base/image.h"
#include "slam/depth/filter_depth.h"

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

/// Inverse z (1/m) of a plane around a pixel, which is linear in the image.
struct ImagePlane {
    double inverse_z = 0;     // 1/m, at the pixel
    glm::dvec2 per_pixel{0};  // 1/m, change from a pixel to the next
    glm::dvec2 centre{0};     // px from the pixel, mean of those that it was fitted to

    double depth_at(int dx, int dy) const;  // m; not finite or negative behind the plane's horizon
};

/// The plane through the measured pixels around (x, y) that a surface may reach from there without
/// receding by more than settings.steepest a pixel. Empty where these are few or all in one line,
/// as the pixels that hang between two surfaces are, or where the plane misses the pixel itself.
/// With `counted` only pixels where it is not 0 count.
std::optional<ImagePlane> steep_plane(const Image<float>& depth, const glm::ivec2& at,
                                      const DepthSettings& settings,
                                      const Image<unsigned char>* counted = nullptr);

}  // namespace inlay
