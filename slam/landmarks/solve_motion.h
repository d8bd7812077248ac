// The rigid motion that most pairs of points agree on.
#pragma once

#include "recordings/base/pose.h"

#include <optional>
#include <span>
#include <vector>

namespace inlay {

/// One point as seen from two cameras (m, z > 0).
struct PointPair {
    glm::dvec3 from{0}, to{0};
};

struct SolvedMotion {
    Pose from_to;               // takes the `to` camera's frame into the `from` camera's
    std::vector<int> inliers;   // indices of the pairs that agree with it, ascending
    double sigma = 0;           // m, of the translation in its least certain direction
    double rotation_sigma = 0;  // rad, likewise
};

/// The motion that takes a triple of pairs onto each other and agrees with most others: RANSAC
/// (Fischler and Bolles 1981) whose numbers depend on nothing but the pairs' count. Empty if no
/// triple agrees with any.
std::optional<Pose> sample_motion(std::span<const PointPair> pairs);

/// Gauss-Newton from `start` over the pairs that agree with it, with the noise of corners and of
/// depth. Empty where they do not tell a motion.
std::optional<SolvedMotion> refine_motion(const Pose& start, std::span<const PointPair> pairs);

}  // namespace inlay
