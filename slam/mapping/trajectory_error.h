// Absolute and relative trajectory error.
#pragma once

#include "recordings/base/pose.h"

#include <span>

namespace inlay {

struct TrajectoryError {
    double rms = 0;      // m
    double mean = 0;     // m
    double largest = 0;  // m
    double rms_angle =
        0;  // rad; of absolute errors only as good as the alignment (a straight path has none)
};

/// The rigid motion that takes `estimated` positions closest to `reference` ones, in the least
/// squares sense. Umeyama 1991, eq. 40 to 42 without scale. Both spans have the same length >= 1.
Pose align(std::span<const Pose> estimated, std::span<const Pose> reference);

/// Absolute trajectory error: distances (m) and angles (rad) after align(). Sturm et al. 2012,
/// Sec. IV B. Throws Error unless both have the same length >= 1.
TrajectoryError absolute_error(std::span<const Pose> estimated, std::span<const Pose> reference);

/// Relative pose error over steps of `frames` >= 1 frames, per step. Sturm et al. 2012, Sec. IV A.
/// Throws Error unless both have the same length > frames.
TrajectoryError relative_error(std::span<const Pose> estimated, std::span<const Pose> reference,
                               int frames);

}  // namespace inlay
