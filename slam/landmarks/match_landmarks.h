// How the camera moved between two views that show the same landmarks.
#pragma once

#include "recordings/base/pose.h"
#include "slam/landmarks/landmarks.h"

#include <optional>

namespace inlay {

struct LandmarkMotion {
    Pose from_to;               // takes the `to` camera's frame into the `from` camera's
    int pairs = 0;              // of landmarks that look alike where the motion expects them
    int inliers = 0;            // of these, the ones that agree with it
    double sigma = 0;           // m, of the translation in its least certain direction
    double rotation_sigma = 0;  // rad, likewise
};

/// Needs no guess of the motion. Empty unless so many landmarks, so well spread, agree that chance,
/// or a pattern that repeats, does not explain it. Same bytes for any number of threads.
std::optional<LandmarkMotion> match_landmarks(const Landmarks& from, const Landmarks& to);

/// How many of the first 150 landmarks of either view look alike: a quick guess which of many views
/// match_landmarks() will find a motion to.
int likeness(const Landmarks& a, const Landmarks& b);

}  // namespace inlay
