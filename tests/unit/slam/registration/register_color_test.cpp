// The estimate of color-from-depth registration on a rig that is known exactly.
#include "slam/registration/register_color.h"

#include "recordings/base/check.h"
#include "tests/unit/slam/registration/boxes_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace inlay {
namespace {

using test::Rig;

constexpr int frame_count = 14;

Lens lens_of(double focal_length) { return {320, 240, focal_length, focal_length, 159.5, 119.5}; }

Rig registered_rig() { return {lens_of(280), lens_of(280), {}, 0}; }

/// As a Kinect that nobody registered: 25 mm of baseline, a wider color camera, a late image.
Rig apart_rig() {
    return {lens_of(280), lens_of(250), test::posed({0.008, -0.012, 0.006}, {-0.025, 0.003, 0.004}),
            0.02};
}

ColorRegistration register_rig(const Rig& rig, const Lens& believed, bool lens_known) {
    RegistrationSettings settings;
    settings.lens_known = lens_known;
    return register_color(test::rig_frames(rig, frame_count), rig.depth_lens, believed,
                          test::rig_trajectory(frame_count), settings);
}

void expect_pose(const Pose& found, const Pose& truth) {
    // Rims and edges are cut off at whole pixels, alike all along a line: 0.2 px on average remain,
    // by which a turn and a translation may differ together (0.6 mm is 0.1 px at 1.6 m). A baseline
    // along z looks much like focal length, and its prior pulls it towards 0.
    EXPECT_LT(rotation_angle(found, truth), 0.001);
    EXPECT_NEAR(found.translation.x, truth.translation.x, 0.0015);
    EXPECT_NEAR(found.translation.y, truth.translation.y, 0.0015);
    EXPECT_NEAR(found.translation.z, truth.translation.z, 0.003);
}

void expect_no_estimate(const ColorRegistration& result) {
    EXPECT_EQ(result.points, 0);
    EXPECT_FALSE(result.needed);
    EXPECT_FALSE(result.delay_needed);
    EXPECT_EQ(result.color_from_depth.rotation, glm::dmat3(1.0));
    EXPECT_EQ(result.color_from_depth.translation, glm::dvec3(0.0));
    EXPECT_EQ(result.delay, 0);
    EXPECT_EQ(result.sd_px, 0);
}

TEST(RegisterColor, FindsPoseFocalLengthAndDelay) {
    const Rig rig = apart_rig();
    const ColorRegistration result = register_rig(rig, lens_of(280), false);
    expect_pose(result.color_from_depth, rig.color_from_depth);
    EXPECT_NEAR(result.color_lens.fx, 250, 0.5);  // 0.3 px at the image's border
    EXPECT_NEAR(result.color_lens.fy / result.color_lens.fx, 1, 1e-12);
    EXPECT_NEAR(result.delay, rig.delay, 0.001);  // s; 0.15 px at 0.5 rad/s
    EXPECT_TRUE(result.needed);
    EXPECT_TRUE(result.delay_needed);
    EXPECT_GT(result.shift_px, 5);
    EXPECT_LT(result.distance_after, 0.5 * result.distance_before);
    EXPECT_GT(result.near_after, result.near_before);
    EXPECT_LT(result.sd_px, 0.5);
}

TEST(RegisterColor, AKnownLensIsKept) {
    const Rig rig = apart_rig();
    const ColorRegistration result = register_rig(rig, rig.color_lens, true);
    expect_pose(result.color_from_depth, rig.color_from_depth);
    EXPECT_EQ(result.color_lens.fx, 250);
    EXPECT_EQ(result.focal_sd, 0);
    EXPECT_NEAR(result.delay, rig.delay, 0.001);
}

TEST(RegisterColor, ARegisteredRecordingNeedsNothing) {
    const ColorRegistration result = register_rig(registered_rig(), lens_of(280), false);
    EXPECT_GT(result.points, 1000);
    EXPECT_FALSE(result.needed);
    EXPECT_FALSE(result.delay_needed);
    EXPECT_EQ(result.color_lens.fx, 280);  // no significant change: kept
    EXPECT_LT(result.shift_px, 0.5);       // a pixel's rounding of rims and edges
}

TEST(RegisterColor, WithoutPosesThereIsNoDelay) {
    Rig rig = apart_rig();
    rig.delay = 0;
    const auto frames = test::rig_frames(rig, frame_count);
    const ColorRegistration result = register_color(frames, rig.depth_lens, lens_of(280), {});
    expect_pose(result.color_from_depth, rig.color_from_depth);
    EXPECT_EQ(result.delay, 0);
    EXPECT_EQ(result.delay_px, 0);
    EXPECT_FALSE(result.delay_needed);
}

TEST(RegisterColor, ImagesMayDifferInSizeAndLensesMayDistort) {
    Rig rig = apart_rig();
    rig.color_lens = {400, 240, 250, 250, 199.5, 119.5, 0.05, -0.04, 0, 0.001, -0.001};
    rig.depth_lens.k1 = -0.03;
    const ColorRegistration result = register_rig(rig, rig.color_lens, true);
    expect_pose(result.color_from_depth, rig.color_from_depth);
}

TEST(RegisterColor, TooLittleToSeeIsNoEstimate) {
    const Rig rig = registered_rig();
    const auto trajectory = test::rig_trajectory(frame_count);
    const auto result_of = [&](const std::vector<RegistrationFrame>& frames) {
        return register_color(frames, rig.depth_lens, rig.color_lens, trajectory);
    };
    expect_no_estimate(result_of({}));
    expect_no_estimate(result_of(test::rig_frames(rig, 1)));
    for (const float z : {0.0f, 2.0f, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()}) {
        std::vector<RegistrationFrame> frames(4);
        for (RegistrationFrame& frame : frames)
            frame = {Image<float>(320, 240, z), Image<EncodedRgb>(320, 240), 0};
        expect_no_estimate(result_of(frames));
    }
}

TEST(RegisterColor, ImagesOfOnePixelAreNoEstimate) {
    const Lens dot{1, 1, 1, 1, 0, 0};
    const std::vector<RegistrationFrame> frames(
        4, {Image<float>(1, 1, 1.0f), Image<EncodedRgb>(1, 1), 0});
    expect_no_estimate(register_color(frames, dot, dot, {}));
}

TEST(RegisterColor, ColorWithoutEdgesSaysNothing) {
    const Rig rig = registered_rig();
    for (const int size : {1, 2, 5, 320}) {
        const Lens lens{size, size, 280, 280, 0.5 * (size - 1), 0.5 * (size - 1)};
        auto frames = test::rig_frames(rig, 3);
        for (RegistrationFrame& frame : frames)
            frame.color = Image<EncodedRgb>(size, size, EncodedRgb{90, 90, 90});
        const ColorRegistration result = register_color(frames, rig.depth_lens, lens, {});
        EXPECT_FALSE(result.needed);
        EXPECT_LT(glm::length(result.color_from_depth.translation), 1e-9);
        EXPECT_LT(rotation_angle(result.color_from_depth, {}), 1e-9);
        EXPECT_TRUE(std::isfinite(result.distance_after + result.near_after + result.sd_px));
    }
}

TEST(RegisterColor, RefusesWrongInput) {
    const Rig rig = registered_rig();
    const auto frames = test::rig_frames(rig, 3);
    const Lens small = scaled(rig.color_lens, 160, 120);
    EXPECT_THROW(register_color(frames, small, rig.color_lens, {}), Error);
    EXPECT_THROW(register_color(frames, rig.depth_lens, small, {}), Error);
    EXPECT_THROW(register_color({}, Lens{}, rig.color_lens, {}), Error);
    const std::vector<TimedCamera> backwards{{1, {}}, {0, {}}};
    EXPECT_THROW(register_color(frames, rig.depth_lens, rig.color_lens, backwards), Error);
    RegistrationSettings settings;
    settings.points = 0;
    EXPECT_THROW(register_color(frames, rig.depth_lens, rig.color_lens, {}, settings), Error);
}

TEST(RegisterColor, SpreadFramesReachFromTheFirstToTheLast) {
    EXPECT_EQ(spread_frames(10, 4), (std::vector<int>{0, 3, 6, 9}));
    EXPECT_EQ(spread_frames(3, 30), (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(spread_frames(9, 1), (std::vector<int>{4}));
    EXPECT_TRUE(spread_frames(0, 30).empty());
}

}  // namespace
}  // namespace inlay
