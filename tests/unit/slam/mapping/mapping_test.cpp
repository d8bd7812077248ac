// The step per frame on a room that is known exactly, earlier views, and trajectory errors.
#include "recordings/base/check.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/trajectory_error.h"
#include "slam/track/se3.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace inlay {
namespace {

/// A hand-held path: centimetres and degrees, smooth.
Pose path(int i) {
    const double t = 0.1 * i;
    return test::posed({0.05 * std::sin(t), 0.2 * std::sin(0.7 * t), 0.04 * std::sin(1.3 * t)},
                       {0.15 * std::sin(t), 0.05 * std::sin(1.7 * t), 0.1 * std::sin(0.5 * t)});
}

TEST(AdvanceSlam, FollowsANoisyRecordingOfAKnownRoom) {
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    std::vector<Pose> estimated, truth;
    for (int i = 0; i < 40; ++i) {
        RgbdFrame frame = test::room_frame(i, path(i), 1);
        frame.recorded_world_from_camera = i == 0 ? path(0) : test::posed({1, 1, 1}, {9, 9, 9});
        const SlamStep step = advance_slam(state, frame, settings, std::nullopt);
        EXPECT_EQ(step.tracking.status, TrackingStatus::tracked) << i;
        estimated.push_back(step.tracking.world_from_camera);
        truth.push_back(path(i));
    }
    for (std::size_t i = 0; i < truth.size(); ++i) {
        // 20 thousand pixels of 4 mm noise leave 0.03 mm a frame, edges more; a voxel is 8 mm.
        EXPECT_LT(glm::length(estimated[i].translation - truth[i].translation), 0.004) << i;
        EXPECT_LT(rotation_angle(estimated[i], truth[i]), 0.004) << i;
    }
}

TEST(AdvanceSlam, TheSurfaceIsLessNoisyThanTheDepth) {
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    SlamStep step;
    for (int i = 0; i < 20; ++i) {
        step = advance_slam(state, test::room_frame(i, path(i), 1), settings, path(i));
    }
    const RgbdFrame last = test::room_frame(19, path(19), 1);
    const Image<float> exact = test::room_depth(last.lens, path(19));
    double of_surface = 0, of_depth = 0;
    int count = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        const float z = step.surface.position.pixels[i].z;
        if (z <= 0 || std::abs(z - exact.pixels[i]) > 0.03f) continue;
        of_surface += std::pow(z - exact.pixels[i], 2);
        of_depth += std::pow(last.depth.pixels[i] - exact.pixels[i], 2);
        ++count;
    }
    EXPECT_GT(count, 0.9 * double(exact.pixels.size()));
    // Twenty views would give 1/20 of the variance; slanted and curved pixels keep some.
    EXPECT_LT(of_surface, of_depth / 4);
}

TEST(AdvanceSlam, CompletesTheModelByTheFramesOwnDepth) {
    SlamSettings settings;
    settings.fusion.least_cosine = 0.9f;  // most of the room is too slanted to be fused
    SlamState state = start_slam(settings);
    const SlamStep step = advance_slam(state, test::room_frame(0, Pose{}), settings, std::nullopt);
    std::size_t holes = 0;
    for (const glm::vec3& p : step.surface.position.pixels)
        holes += p.z <= 0;
    // Left are the rims of the balls, too steep for a normal: 550 px around, one or two deep.
    EXPECT_LT(holes, 1100U);
    EXPECT_TRUE(same_size(step.surface.position, test::room_frame(0, Pose{}).depth));
}

TEST(AdvanceSlam, RefusesImagesOfTheWrongSize) {
    SlamState state = start_slam({});
    RgbdFrame frame = test::room_frame(0, Pose{});
    frame.depth = Image<float>(3, 3);
    EXPECT_THROW(advance_slam(state, frame, {}, std::nullopt), Error);
}

TEST(Keyframes, TheViewThatLooksAlikeComesFirst) {
    std::vector<Keyframe> keyframes;
    const std::vector<Pose> poses{test::posed({0, 0, 0}, {}), test::posed({0, 0.5, 0}, {}),
                                  test::posed({0.4, -0.3, 0}, {})};
    for (const Pose& pose : poses) {
        remember_view(keyframes, pose, test::room_depth(test::small_lens(), pose));
        remember_view(keyframes, pose, test::room_depth(test::small_lens(), pose));
    }
    ASSERT_EQ(keyframes.size(), 3U);
    for (const Pose& pose : poses) {
        const Pose near = pose * test::posed({0.02, 0.02, 0}, {0.01, 0, 0.01});
        const auto views = similar_views(keyframes, test::room_depth(test::small_lens(), near), 2);
        ASSERT_EQ(views.size(), 2U);
        EXPECT_EQ(rotation_angle(views[0], pose), 0);
    }
}

TEST(TrajectoryError, ARigidlyMovedTrajectoryHasNone) {
    std::vector<Pose> reference, moved;
    const Pose elsewhere = exponential({{0.4, -1.1, 2}, {3, 5, -7}});
    for (int i = 0; i < 50; ++i) {
        reference.push_back(path(i));
        moved.push_back(elsewhere * path(i));
    }
    EXPECT_LT(absolute_error(moved, reference).rms, 1e-12);
    EXPECT_LT(relative_error(moved, reference, 5).rms, 1e-12);
    EXPECT_LT(rotation_angle(align(moved, reference), inverse(elsewhere)), 1e-12);
}

TEST(TrajectoryError, AKnownDriftIsMeasured) {
    std::vector<Pose> reference, drifting;
    for (int i = 0; i < 11; ++i) {
        reference.push_back(test::posed({}, {0.1 * i, 0, 0}));
        drifting.push_back(test::posed({}, {0.11 * i, 0, 0}));
    }
    // Centred, the error is 0.01 (i - 5): rms 0.01 sqrt(10), largest 0.05.
    const TrajectoryError absolute = absolute_error(drifting, reference);
    EXPECT_NEAR(absolute.rms, 0.01 * std::sqrt(10.0), 1e-12);
    EXPECT_NEAR(absolute.largest, 0.05, 1e-12);
    EXPECT_NEAR(relative_error(drifting, reference, 2).mean, 0.02, 1e-12);
    EXPECT_THROW(relative_error(drifting, reference, 11), Error);
}

}  // namespace
}  // namespace inlay
