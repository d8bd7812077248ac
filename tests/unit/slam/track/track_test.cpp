// Rigid motions, the point-to-plane system, and the tracker on a room that is known exactly.
#include "slam/depth/depth_pyramid.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/track/constrained_step.h"
#include "slam/track/icp_system.h"
#include "slam/track/se3.h"
#include "slam/track/track_frame.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace inlay {
namespace {

using test::small_lens;

std::vector<Twist> some_twists() {
    return {{{0, 0, 0}, {0, 0, 0}},           {{1e-9, 0, 0}, {1, 2, 3}},
            {{1e-3, -2e-3, 1e-4}, {0, 1, 0}}, {{0.3, -0.2, 0.5}, {-1, 0.5, 2}},
            {{0, 3.1, 0}, {1, 1, 1}},         {{0.009, 0.004, 0.001}, {5, -7, 9}}};
}

TEST(Se3, LogarithmUndoesExponential) {
    for (const Twist& twist : some_twists()) {
        const Twist back = logarithm(exponential(twist));
        // Angles near pi lose digits in the quaternion's real part: 1e-9 covers them.
        EXPECT_LT(glm::length(back.rotation - twist.rotation), 1e-9);
        EXPECT_LT(glm::length(back.translation - twist.translation), 1e-8);
    }
}

TEST(Se3, ExponentialIsRigid) {
    for (const Twist& twist : some_twists()) {
        const Pose pose = exponential(twist);
        EXPECT_NEAR(glm::determinant(pose.rotation), 1, 1e-12);
        const glm::dmat3 identity = glm::transpose(pose.rotation) * pose.rotation;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(identity[i][i], 1, 1e-12);
        EXPECT_NEAR(rotation_angle(Pose{}, pose), glm::length(twist.rotation), 1e-9);
    }
}

TEST(Se3, HalfATwistTwiceIsTheWhole) {
    for (const Twist& twist : some_twists()) {
        const Pose half = exponential({0.5 * twist.rotation, 0.5 * twist.translation});
        const Pose whole = exponential(twist);
        EXPECT_LT(glm::length((half * half).translation - whole.translation), 1e-12);
    }
}

TEST(Se3, DerivativeAtZeroMovesPointsAsTheTrackerAssumes) {
    const glm::dvec3 p(0.3, -0.7, 1.9);
    const double h = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
        Twist turn, shift;
        turn.rotation[axis] = h;
        shift.translation[axis] = h;
        glm::dvec3 unit(0);
        unit[axis] = 1;
        // One-sided differences err by h |p| / 2.
        EXPECT_LT(glm::length((exponential(turn) * p - p) / h - glm::cross(unit, p)), 1e-5);
        EXPECT_LT(glm::length((exponential(shift) * p - p) / h - unit), 1e-5);
    }
}

SurfaceMap room_surface(const Pose& world_from_camera) {
    return surface_from_depth(test::room_depth(small_lens(), world_from_camera), small_lens(),
                              world_from_camera);
}

TEST(IcpSystem, OneStepUndoesASmallMotion) {
    const SurfaceMap model = room_surface(Pose{});
    for (int i = 0; i < 6; ++i) {
        Twist moved;
        (i < 3 ? moved.rotation[i] : moved.translation[i - 3]) = 0.002;
        const Pose model_from_observed = exponential(moved);
        const SurfaceMap observed = room_surface(model_from_observed);
        const IcpSystem system = icp_system(observed, model, Pose{}, {0.1f, 0.8f, 1});
        const Twist step = constrained_step(system, 1e-6).twist;
        // Half a percent of the pairs meet an edge or a curved pixel wrongly, with residuals of
        // millimetres: a tenth of the motion is their share.
        EXPECT_LT(glm::length(step.rotation - moved.rotation), 2e-4) << i;
        EXPECT_LT(glm::length(step.translation - moved.translation), 2e-4) << i;
    }
}

TEST(IcpSystem, CountsWhatIsSeen) {
    const SurfaceMap model = room_surface(Pose{});
    const IcpSystem same = icp_system(model, model, Pose{}, {0.1f, 0.8f, 1});
    EXPECT_EQ(same.seen, same.observed);
    EXPECT_EQ(same.inliers, same.observed);
    EXPECT_NEAR(same.squared_residual, 0, 1e-9);
    const IcpSystem apart = icp_system(model, model, test::posed({0, 3, 0}, {}), {0.1f, 0.8f, 1});
    EXPECT_EQ(apart.seen, 0);
    EXPECT_EQ(constrained_step(apart, 1e-5).free_axes, 6);
}

TEST(ConstrainedStep, APlaneConstrainsThreeDirections) {
    const Lens lens = small_lens();
    const SurfaceMap model =
        surface_from_depth(Image<float>(lens.width, lens.height, 1.0f), lens, Pose{});
    const SurfaceMap nearer =
        surface_from_depth(Image<float>(lens.width, lens.height, 0.99f), lens, Pose{});
    const ConstrainedStep step =
        constrained_step(icp_system(nearer, model, Pose{}, {0.1f, 0.8f, 5}), 1e-5);
    EXPECT_EQ(step.free_axes, 3);  // along the plane, and about its normal
    EXPECT_NEAR(step.twist.translation.z, 0.01, 1e-5);
    EXPECT_NEAR(step.twist.translation.x, 0, 1e-6);
    EXPECT_NEAR(step.twist.rotation.z, 0, 1e-6);
}

std::vector<SurfaceMap> room_pyramid(const RgbdFrame& frame) {
    std::vector<SurfaceMap> pyramid;
    for (const DepthLevel& level :
         depth_pyramid(filter_depth(frame.depth, {}), frame.lens, 3, {})) {
        pyramid.push_back(surface_from_depth(level.depth, level.lens, Pose{}));
    }
    return pyramid;
}

TEST(TrackFrame, RecoversAKnownMotion) {
    const Pose start = test::posed({0.02, -0.1, 0.03}, {0.05, 0.0, -0.1});
    const SurfaceMap model = room_surface(start);
    const std::vector<Pose> motions{test::posed({0.03, 0.04, -0.02}, {0.02, 0.01, 0.03}),
                                    test::posed({-0.02, 0.06, 0.04}, {-0.03, 0.02, 0}),
                                    test::posed({0, 0, 0}, {0.04, -0.03, -0.03})};
    for (const Pose& motion : motions) {
        const Pose truth = start * motion;
        const auto pyramid = room_pyramid(test::room_frame(0, truth));
        const TrackResult result = track_frame(pyramid, model, std::vector<Pose>{start}, {});
        EXPECT_EQ(result.status, TrackingStatus::tracked);
        // A pixel is 1 cm wide at the room's distance; edges, smoothed differently in the two
        // views, leave a few percent of that.
        EXPECT_LT(glm::length(result.world_from_camera.translation - truth.translation), 1.5e-3);
        EXPECT_LT(rotation_angle(result.world_from_camera, truth), 1.5e-3);
    }
}

TEST(TrackFrame, TakesTheStartThatExplainsMore) {
    const SurfaceMap model = room_surface(Pose{});
    const Pose truth = test::posed({0, 0.3, 0}, {0, 0, 0});
    const auto pyramid = room_pyramid(test::room_frame(0, truth));
    const Pose near = test::posed({0, 0.28, 0}, {0, 0, 0}), far = test::posed({0, -0.3, 0}, {});
    for (const auto& starts : {std::vector<Pose>{near, far}, std::vector<Pose>{far, near}}) {
        const TrackResult result = track_frame(pyramid, model, starts, {});
        EXPECT_LT(rotation_angle(result.world_from_camera, truth), 2e-3);
    }
}

TEST(TrackFrame, WithoutOverlapIsLost) {
    const SurfaceMap model = room_surface(Pose{});
    const Pose away = test::posed({0, 2.5, 0}, {});
    const auto pyramid = room_pyramid(test::room_frame(0, Pose{}));
    const TrackResult result = track_frame(pyramid, model, std::vector<Pose>{away}, {});
    EXPECT_EQ(result.status, TrackingStatus::lost);
}

}  // namespace
}  // namespace inlay
