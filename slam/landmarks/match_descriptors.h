// Which landmarks of two views look alike.
#pragma once

#include "slam/landmarks/landmarks.h"

#include <span>
#include <vector>

namespace inlay {

/// Indices of two landmarks that look alike.
struct LandmarkPair {
    int from = 0, to = 0;
};

/// How many bits differ (Hamming distance).
int difference(const LandmarkDescriptor& a, const LandmarkDescriptor& b);

/// Pairs that are each other's nearest, near enough, and distinctly nearer than the second nearest
/// on either side (Lowe 2004, Sec. 7.1). In the order of `from`.
std::vector<LandmarkPair> match_descriptors(std::span<const LandmarkDescriptor> from,
                                            std::span<const LandmarkDescriptor> to);

}  // namespace inlay
