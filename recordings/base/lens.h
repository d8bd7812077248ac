// Lens: the pinhole camera with Brown-Conrady distortion. Image coordinates are OpenCV's: (0, 0) is
// the CENTRE of the top-left pixel; camera axes are x right, y down, z forward.
#pragma once

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

struct Lens {
    int width = 0, height = 0;      // px
    double fx = 0, fy = 0;          // px; fy may be negative (some synthetic data sets)
    double cx = 0, cy = 0;          // px, the principal point
    double k1 = 0, k2 = 0, k3 = 0;  // radial distortion, 1
    double p1 = 0, p2 = 0;          // tangential distortion, 1
};

inline bool distorted(const Lens& lens) {
    return lens.k1 != 0 || lens.k2 != 0 || lens.k3 != 0 || lens.p1 != 0 || lens.p2 != 0;
}

/// The same lens without its distortion.
Lens pinhole(const Lens& lens);

/// The lens of the same view at `width` x `height` px: f' = f s, c' = (c + 1/2) s - 1/2.
Lens scaled(const Lens& lens, int width, int height);

/// Where a point in camera coordinates (m, z > 0) appears (px). Brown-Conrady as OpenCV's.
glm::dvec2 project(const Lens& lens, const glm::dvec3& p_camera);

/// The ray through an image position (px): direction in camera coordinates with z = 1, so that
/// z-depth times it is the point. Undistorts by fixed-point iteration to 1e-10.
glm::dvec3 unproject(const Lens& lens, const glm::dvec2& pixel);

/// The pixel whose area holds an image position; empty outside the image or for NaN.
std::optional<glm::ivec2> nearest_pixel(const Lens& lens, const glm::dvec2& position);

}  // namespace inlay
