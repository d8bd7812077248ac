// Exponential and logarithm of rigid motions.
#pragma once

#include "recordings/base/pose.h"

namespace inlay {

/// A small motion. The rotation is a vector along the axis, as long as the angle (rad).
struct Twist {
    glm::dvec3 rotation{0};     // rad
    glm::dvec3 translation{0};  // m, before the exponential couples it with the rotation
};

/// The motion that a constant twist makes in unit time. Murray, Li and Sastry 1994, eq. 2.36.
Pose exponential(const Twist& twist);

/// Its inverse, for rotation angles below pi.
Twist logarithm(const Pose& motion);

/// The nearest rotation to a product of many, so that rounding does not add up.
Pose orthonormalized(const Pose& pose);

}  // namespace inlay
