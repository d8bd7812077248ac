// The step that one ICP system asks for, in the directions that it knows about.
#pragma once

#include "slam/track/icp_system.h"
#include "slam/track/se3.h"

namespace inlay {

struct ConstrainedStep {
    Twist twist;        // in the frame of the model's camera
    int free_axes = 6;  // directions in which the system does not constrain the motion
};

/// Solves A x = b by its eigenvectors, with rotations measured as the path (m) of a point at the
/// pairs' mean distance. Directions whose eigenvalue, per unit of weight, is no more than
/// `least_information` get no step (Zhang, Kaess and Singh 2016, Sec. IV): 1 would be a direction
/// that every pair constrains fully, and normals with a noise of s rad make s^2 of nothing.
ConstrainedStep constrained_step(const IcpSystem& system, double least_information);

}  // namespace inlay
