// How much of a view an object can cover at most, from its bounds.
#pragma once

#include "composite/plan/object_bounds.h"
#include "recordings/base/lens.h"

#include <glm/glm.hpp>

namespace inlay {

/// All that a lens sees, as a rectangle of x / z and y / z.
struct ViewWindow {
    glm::dvec2 least{0.0}, greatest{0.0};
    glm::dvec2 pixels_per_unit{0.0};  // |fx|, |fy|
};

/// Holds the ray through every point of every pixel, distortion included: the border is undistorted
/// pixel by pixel.
ViewWindow view_window(const Lens& lens);

/// A ball that holds an object, in the camera's frame.
struct Ball {
    glm::dvec3 centre{0.0};  // m
    double radius = 0;       // m
};

/// Around the bounds of an object that is placed by `camera_from_object`, with a margin for the
/// tracer's single precision.
Ball ball_of(const ObjectBounds& bounds, const glm::dmat4& camera_from_object);

/// What an object covers of the image at most. Conservative: it covers no more than this.
struct ObjectInView {
    bool possible = false;      // whether a camera ray may meet it; surfaces in front are ignored
    glm::dvec2 size_px{0.0};    // undistorted, whole, also where it reaches out of the image;
                                // infinite where the object reaches the camera's plane
    double share_of_view = 0;   // 0..1
    double share_with_rim = 0;  // the same with `rim_px` more on each side
};

/// Pixels around an object that may take more samples since they share a tile with it.
inline constexpr double rim_px = 16;

/// From the bounds of an object, placed by `camera_from_object` (camera axes as Lens has them).
ObjectInView object_in_view(const ObjectBounds& bounds, const glm::dmat4& camera_from_object,
                            const ViewWindow& window);

}  // namespace inlay
