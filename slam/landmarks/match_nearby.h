// Which landmarks of two views look alike where a motion expects them.
#pragma once

#include "recordings/base/pose.h"
#include "slam/landmarks/match_descriptors.h"

#include <vector>

namespace inlay {

/// Pairs that lie within 0.025 rad and 8 % of depth where `from_to` takes the one, and there are
/// each other's most alike. Finds many that match_descriptors() leaves out since the whole view
/// holds others like them. In the order of `from`.
std::vector<LandmarkPair> match_nearby(const Landmarks& from, const Landmarks& to,
                                       const Pose& from_to);

}  // namespace inlay
