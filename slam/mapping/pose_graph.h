// Poses that agree best with many measured motions between them.
#pragma once

#include "recordings/base/pose.h"

#include <array>
#include <span>
#include <vector>

namespace inlay {

/// A measured motion from one camera to another, with what it is known by.
struct PoseEdge {
    int from = 0, to = 0;  // numbers of poses
    Pose motion;           // takes points of `to`'s camera into `from`'s
    /// Upper triangle, row by row, of the information of a twist (rotation in rad, translation in
    /// m) in `from`'s camera frame: the motion's uncertainty is its inverse.
    std::array<double, 21> information{};
};

struct PoseGraphSettings {
    int iterations = 20;  // at most
    double outlier = 5;   // times the median deviation of the edges: there an edge weighs half
    double still = 1e-7;  // rad and m; smaller steps end the search
};

/// Moves `world_from_camera` so that the edges' weighted squared deviations become least; the first
/// pose stays. Gauss-Newton with Cauchy weights on the edges. Poses that no edge reaches stay where
/// they are. Returns the rms deviation of the edges, in the units of their information, before and
/// after. Grisetti et al. 2010, Sec. IV. Throws Error for an edge to a pose that is not there.
std::array<double, 2> optimize_poses(std::vector<Pose>& world_from_camera,
                                     std::span<const PoseEdge> edges,
                                     const PoseGraphSettings& settings = {});

}  // namespace inlay
