// Poses from motions between them.
#include "slam/mapping/pose_graph.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "slam/mapping/trajectory_error.h"
#include "slam/track/se3.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

constexpr int count = 40;

/// A camera that goes around a circle of 2 m, looking outwards.
std::vector<Pose> circle() {
    std::vector<Pose> poses;
    for (int i = 0; i < count; ++i) {
        const double angle = 2 * 3.14159265 * i / count;
        poses.push_back(test::posed({0, angle, 0}, {2 * std::sin(angle), 0, 2 * std::cos(angle)}));
    }
    return poses;
}

/// A motion with noise of a few millimetres and milliradians.
PoseEdge measured(const std::vector<Pose>& truth, int from, int to, double noise) {
    const SampleKey key{9, std::uint32_t(from), std::uint32_t(to), 0};
    const auto error = [&](std::uint32_t i) { return noise * (2 * double(uniform(key, i)) - 1); };
    const Twist wrong{{error(0), error(1), error(2)}, {error(3), error(4), error(5)}};
    PoseEdge edge{from,
                  to,
                  exponential(wrong) * inverse(truth[std::size_t(from)]) * truth[std::size_t(to)],
                  {}};
    for (const std::size_t diagonal : {0, 6, 11, 15, 18, 20})
        edge.information[diagonal] = 1;
    return edge;
}

/// Each pose from the one before it.
std::vector<Pose> chained(const std::vector<PoseEdge>& edges) {
    std::vector<Pose> poses{circle().front()};
    for (const PoseEdge& edge : edges)
        poses.push_back(poses.back() * edge.motion);
    return poses;
}

std::vector<PoseEdge> odometry(double noise) {
    std::vector<PoseEdge> edges;
    for (int i = 0; i + 1 < count; ++i)
        edges.push_back(measured(circle(), i, i + 1, noise));
    return edges;
}

TEST(PoseGraph, ALoopTakesOutTheDrift) {
    std::vector<PoseEdge> edges = odometry(0.004);
    std::vector<Pose> poses = chained(edges);
    const Pose end_before = inverse(circle().back()) * poses.back();
    edges.push_back(measured(circle(), 0, count - 1, 0.004));
    const auto rms = optimize_poses(poses, edges);
    const Pose end_after = inverse(circle().back()) * poses.back();
    // The end is known by one edge now, as well as each neighbor was.
    EXPECT_LT(glm::length(end_after.translation), 0.01);
    EXPECT_LT(glm::length(end_after.translation), 0.5 * glm::length(end_before.translation));
    EXPECT_LT(rms[1], rms[0]);
    EXPECT_LT(absolute_error(poses, circle()).rms, 0.02);  // 4 mm times the root of 40 steps
}

TEST(PoseGraph, ExactEdgesGiveExactPosesFromABadStart) {
    std::vector<PoseEdge> edges = odometry(0);
    for (int i = 0; i + 7 < count; i += 3)
        edges.push_back(measured(circle(), i, i + 7, 0));
    std::vector<Pose> poses = circle();
    for (int i = 1; i < count; ++i) {
        const double off = 0.01 * (i % 5);
        poses[std::size_t(i)] = poses[std::size_t(i)] * exponential({{off, 0, -off}, {0, off, 0}});
    }
    optimize_poses(poses, edges);
    for (int i = 0; i < count; ++i) {
        const Pose off = inverse(circle()[std::size_t(i)]) * poses[std::size_t(i)];
        EXPECT_LT(glm::length(off.translation), 1e-6);  // Gauss-Newton's last step
    }
}

TEST(PoseGraph, AFalseLoopIsOutvoted) {
    std::vector<PoseEdge> edges = odometry(0.001);
    for (int i = 0; i + 5 < count; ++i)
        edges.push_back(measured(circle(), i, i + 5, 0.001));
    edges.push_back(measured(circle(), 3, 30, 0));
    edges.back().motion = Pose{};  // two places that only look alike
    std::vector<Pose> poses = chained(odometry(0.001));
    optimize_poses(poses, edges);
    // Each of 39 steps is off by a millimetre or so: a centimetre at the end; the false loop asks
    // for 3.5 m.
    EXPECT_LT(absolute_error(poses, circle()).rms, 0.01);
}

TEST(PoseGraph, PosesThatNothingReachesStay) {
    std::vector<Pose> poses = circle();
    const std::vector<PoseEdge> edges{measured(circle(), 0, 1, 0.01)};
    optimize_poses(poses, edges);
    EXPECT_LT(glm::length(poses[20].translation - circle()[20].translation), 1e-9);
    EXPECT_EQ(optimize_poses(poses, {})[1], 0);
}

TEST(PoseGraph, RefusesEdgesThatLeadNowhere) {
    std::vector<Pose> poses = circle();
    EXPECT_THROW(optimize_poses(poses, std::vector<PoseEdge>{{0, count, {}, {}}}), Error);
    EXPECT_THROW(optimize_poses(poses, std::vector<PoseEdge>{{3, 3, {}, {}}}), Error);
}

}  // namespace
}  // namespace inlay
