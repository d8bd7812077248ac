#include "slam/landmarks/match_landmarks.h"

#include "slam/landmarks/match_descriptors.h"
#include "slam/landmarks/match_nearby.h"
#include "slam/landmarks/solve_motion.h"

#include <algorithm>
#include <span>
#include <vector>

namespace inlay {
namespace {

constexpr int rematchings = 2;        // of landmarks where the motion expects them
constexpr int quick_landmarks = 150;  // that likeness() looks at

// In measurements between views of real rooms, motions that were off by more than 0.1 m or 5
// degrees failed one of the last three, and views of different rooms had 7 inliers at most.
constexpr std::size_t least_inliers = 16;
constexpr double least_share = 0.5;                // of the pairs where the motion expects them
constexpr double largest_sigma = 0.009;            // m
constexpr double largest_rotation_sigma = 0.0044;  // rad

std::vector<PointPair> points_of(const std::vector<LandmarkPair>& pairs, const Landmarks& from,
                                 const Landmarks& to) {
    std::vector<PointPair> points;
    points.reserve(pairs.size());
    for (const LandmarkPair& pair : pairs) {
        points.push_back({glm::dvec3(from.position[std::size_t(pair.from)]),
                          glm::dvec3(to.position[std::size_t(pair.to)])});
    }
    return points;
}

bool certain(const SolvedMotion& motion, std::size_t pairs) {
    const std::size_t inliers = motion.inliers.size();
    return inliers >= least_inliers && double(inliers) >= least_share * double(pairs) &&
           motion.sigma < largest_sigma && motion.rotation_sigma < largest_rotation_sigma;
}

std::span<const LandmarkDescriptor> first_of(const Landmarks& landmarks) {
    return std::span(landmarks.descriptor)
        .first(std::min<std::size_t>(quick_landmarks, landmarks.descriptor.size()));
}

}  // namespace

int likeness(const Landmarks& a, const Landmarks& b) {
    return int(match_descriptors(first_of(a), first_of(b)).size());
}

std::optional<LandmarkMotion> match_landmarks(const Landmarks& from, const Landmarks& to) {
    std::vector<PointPair> points =
        points_of(match_descriptors(from.descriptor, to.descriptor), from, to);
    const std::optional<Pose> sampled = sample_motion(points);
    if (!sampled) return std::nullopt;
    std::optional<SolvedMotion> solved = refine_motion(*sampled, points);
    for (int i = 0; i < rematchings && solved; ++i) {
        points = points_of(match_nearby(from, to, solved->from_to), from, to);
        solved = refine_motion(solved->from_to, points);
    }
    if (!solved || !certain(*solved, points.size())) return std::nullopt;
    return LandmarkMotion{solved->from_to, int(points.size()), int(solved->inliers.size()),
                          solved->sigma, solved->rotation_sigma};
}

}  // namespace inlay
