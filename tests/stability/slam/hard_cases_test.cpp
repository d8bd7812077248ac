// Recordings that a tracker must survive, and say so where it cannot follow.
#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/depth_scale.h"
#include "tests/support/floating_point_traps.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <limits>
#include <numeric>
#include <optional>
#include <string>

namespace inlay {
namespace {

class SlamHardCases : public ::testing::Test {
protected:
    /// One thread, so that the traps cover all of the work.
    void SetUp() override {
        set_thread_count(1);
        traps.emplace(FE_INVALID | FE_DIVBYZERO);
    }
    void TearDown() override {
        traps.reset();
        set_thread_count(0);
    }

    TrackResult next(const RgbdFrame& frame) {
        return track_and_fuse(state, frame, settings, std::nullopt);
    }

    SlamSettings settings;
    SlamState state = start_slam(settings);

private:
    std::optional<test::FloatingPointTraps> traps;
};

Pose swaying(int i) {
    return test::posed({0.02 * std::sin(0.3 * i), 0.02 * i, 0}, {0.01 * i, 0, 0});
}

double off(const TrackResult& result, const Pose& truth) {
    return glm::length(result.world_from_camera.translation - truth.translation);
}

TEST_F(SlamHardCases, NineteenOfTwentyPixelsMissing) {
    for (int i = 0; i < 3; ++i)
        next(test::room_frame(i, swaying(i), 1));
    for (int i = 3; i < 8; ++i) {
        RgbdFrame frame = test::room_frame(i, swaying(i), 1);
        // Patches of 4 x 4 in every 18 x 18: single pixels have no neighbors to trust them by.
        for (int y = 0; y < frame.depth.height; ++y)
            for (int x = 0; x < frame.depth.width; ++x)
                if (x % 18 >= 4 || y % 18 >= 4) frame.depth(x, y) = 0;
        const TrackResult result = next(frame);
        EXPECT_NE(result.status, TrackingStatus::lost) << i;
        EXPECT_LT(off(result, swaying(i)), 0.02) << i;  // a few voxels
    }
}

TEST_F(SlamHardCases, AStepAtEveryPixelIsNoSurface) {
    RgbdFrame frame = test::room_frame(0, Pose{});
    for (std::size_t i = 0; i < frame.depth.pixels.size(); ++i)
        frame.depth.pixels[i] = 0.5f + 3.5f * uniform({5, 0, std::uint32_t(i), 0}, 0);
    next(frame);
    int surfaces = 0;
    for (const glm::vec3& p : state.seen->position.pixels)
        surfaces += p.z > 0;
    // Steps of 1 to 16 cm of 3.5 m: three of eight random neighbors are rarely that close.
    EXPECT_LT(surfaces, int(frame.depth.pixels.size()) / 20);
}

TEST_F(SlamHardCases, AFrameRepeatedDoesNotMoveTheCamera) {
    const RgbdFrame frame = test::room_frame(0, Pose{}, 1);
    for (int i = 0; i < 5; ++i) {
        const TrackResult result = next(frame);
        EXPECT_EQ(result.status, TrackingStatus::tracked);
        EXPECT_LT(off(result, Pose{}), 0.001);  // the same noise again: nothing to follow
    }
}

TEST_F(SlamHardCases, ATurnByFortyDegreesIsFoundOrSaid) {
    for (int i = 0; i < 4; ++i)
        next(test::room_frame(i, swaying(i), 1));
    const Pose turned = swaying(3) * test::posed({0, 0.7, 0}, {});
    const TrackResult result = next(test::room_frame(4, turned, 1));
    if (result.status == TrackingStatus::tracked) {
        EXPECT_LT(off(result, turned), 0.03);
        EXPECT_LT(rotation_angle(result.world_from_camera, turned), 0.03);
    } else {
        EXPECT_FALSE(result.why.empty());
    }
}

TEST_F(SlamHardCases, ImagesOfAnySize) {
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 7}, {9, 1}, {3, 3}, {17, 13}, {161, 5}}) {
        Lens lens = test::small_lens();
        lens.width = width, lens.height = height;
        lens.cx = width / 2.0, lens.cy = height / 2.0;
        SlamState small = start_slam(settings);
        for (int i = 0; i < 3; ++i) {
            RgbdFrame frame = test::room_frame(i, Pose{}, 0, lens);
            const SlamStep step = advance_slam(small, frame, settings, std::nullopt);
            EXPECT_EQ(step.surface.position.width, width);
            EXPECT_EQ(step.surface.position.height, height);
        }
    }
}

TEST_F(SlamHardCases, DenormalDepthIsNotMeasured) {
    RgbdFrame frame = test::room_frame(0, Pose{});
    for (std::size_t i = 0; i < frame.depth.pixels.size(); i += 2)
        frame.depth.pixels[i] = std::numeric_limits<float>::denorm_min();
    const SlamStep step = advance_slam(state, frame, settings, std::nullopt);
    for (const glm::vec3& p : step.surface.position.pixels)
        EXPECT_TRUE(p.z == 0 || p.z > settings.depth.nearest);
}

TEST_F(SlamHardCases, AModelWithoutRoomSaysSoAndGoesOn) {
    for (const auto& [memory, voxel] : {std::pair{8, 0.008f}, {64, 0.003f}}) {
        settings.fusion.memory = memory;
        settings.fusion.voxel_size = voxel;
        settings.fusion.truncation = 4 * voxel;
        state = start_slam(settings);
        for (int i = 0; i < 4; ++i)
            EXPECT_NE(next(test::room_frame(i, swaying(i), 1)).status, TrackingStatus::lost);
        EXPECT_GT(state.volume.refused, 0U) << memory;
        EXPECT_LE(state.volume.bricks.size() * sizeof(Brick), std::size_t(memory) << 20);
    }
}

/// The camera goes along the left wall, 3 cm from it, towards the corner: the wall fills half of
/// the image, at angles that no depth can be trusted at.
TEST_F(SlamHardCases, ACornerSeenEdgeOn) {
    Pose first;
    for (int i = 0; i < 12; ++i) {
        const Pose pose = test::posed({0, 0, 0}, {-1.17, 0.1, 0.01 * i});
        const TrackResult result = next(test::room_frame(i, pose, 1));
        EXPECT_NE(result.status, TrackingStatus::lost) << i;
        const Pose moved = inverse(test::posed({0, 0, 0}, {-1.17, 0.1, 0})) * pose;
        if (i == 0) first = result.world_from_camera;
        const Pose found = inverse(first) * result.world_from_camera;
        EXPECT_LT(glm::length(found.translation - moved.translation), 0.02) << i;
    }
}

TEST_F(SlamHardCases, DepthOfAnotherScaleIsSaidAndNotTracked) {
    const auto scaled = [](int i, float factor) {
        RgbdFrame frame = test::room_frame(i, swaying(i), 1);
        for (float& z : frame.depth.pixels)
            z *= factor;
        return frame;
    };
    for (int i = 0; i < 4; ++i)
        next(scaled(i, 1));
    const std::size_t bricks = state.volume.bricks.size();
    const TrackResult result = next(scaled(4, 0.2f));
    EXPECT_EQ(result.status, TrackingStatus::lost);
    EXPECT_NE(result.why.find("scale"), std::string::npos) << result.why;
    EXPECT_EQ(state.volume.bricks.size(), bricks);
    EXPECT_NE(next(scaled(5, 1)).status, TrackingStatus::lost);

    const auto recording = [&](float factor) {
        return test::frames_from(6, [=](int i) { return scaled(i, factor); });
    };
    EXPECT_NO_THROW(check_depth_scale(recording(1)));
    for (const float factor : {0.2f, 5.0f}) {  // 1000 units per m taken for 5000, and back
        try {
            reconstruct_recording(recording(factor), settings, PoseSource::tracked,
                                  [](int) { return true; });
            ADD_FAILURE() << factor;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::bad_data);
            EXPECT_NE(std::string(error.what()).find("--depth-scale"), std::string::npos);
        }
    }
}

/// Two thirds of the view are covered by a board, so that little of it fits the model.
RgbdFrame behind_a_board(int i, const Pose& pose) {
    RgbdFrame frame = test::room_frame(i, pose, 1);
    for (int y = 0; y < frame.depth.height; ++y)
        for (int x = 0; x < 2 * frame.depth.width / 3; ++x)
            frame.depth(x, y) = 0.6f;
    return frame;
}

double weight_of(const VoxelVolume& volume) {
    double sum = 0;
    for (const Brick& brick : volume.bricks)
        sum += std::accumulate(brick.weight.begin(), brick.weight.end(), 0.0);
    return sum;
}

TEST_F(SlamHardCases, AWeakFrameChangesTheModelOnlyWhereItWasExpected) {
    for (int i = 0; i < 5; ++i)
        next(test::room_frame(i, Pose{}, 1));
    const double before = weight_of(state.volume);
    const Pose jumped = test::posed({0, 0.06, 0}, {0.05, 0, 0});  // the camera had stood still
    const TrackResult result = next(behind_a_board(5, jumped));
    ASSERT_EQ(result.status, TrackingStatus::weak) << result.inlier_share;
    EXPECT_FALSE(state.fused);
    EXPECT_EQ(weight_of(state.volume), before);
    EXPECT_LT(off(result, jumped), 0.02);
    EXPECT_EQ(next(behind_a_board(6, jumped)).status, TrackingStatus::weak);
    EXPECT_TRUE(state.fused);  // it stayed where it was
    EXPECT_GT(weight_of(state.volume), before);
}

/// Someone goes past 0.8 m in front of the camera, over a third of the image.
TEST_F(SlamHardCases, APersonWalkingThroughDoesNotCarryTheCameraAway) {
    for (int i = 0; i < 20; ++i) {
        RgbdFrame frame = test::room_frame(i, swaying(0), 1);
        const int left = 10 * i - 60;
        for (int y = 10; y < frame.depth.height; ++y)
            for (int x = std::max(0, left); x < std::min(frame.depth.width, left + 50); ++x)
                frame.depth(x, y) = 0.8f + 0.001f * float(std::abs(x - left - 25));
        const TrackResult result = next(frame);
        EXPECT_NE(result.status, TrackingStatus::lost) << i;
        EXPECT_LT(off(result, swaying(0)), 0.01) << i;  // about a voxel
    }
}

}  // namespace
}  // namespace inlay
