// Trajectories and pairing: round trips, closed forms, and what is refused.
#include "recordings/readers/trajectory.h"

#include "recordings/base/check.h"
#include "recordings/readers/pairing.h"
#include "recordings/readers/text_file.h"
#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

#include <limits>

namespace inlay {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;

std::array<double, 16> rows_of(const Pose& pose) {
    std::array<double, 16> rows{};
    for (std::size_t r = 0; r < 3; ++r) {
        for (std::size_t c = 0; c < 3; ++c)
            rows[4 * r + c] = pose.rotation[int(c)][int(r)];
        rows[4 * r + 3] = pose.translation[int(r)];
    }
    rows[15] = 1;
    return rows;
}

TEST(Trajectory, RoundTripKeepsNineDigits) {
    TemporaryFolder folder;
    Trajectory written;
    for (int i = 0; i < 50; ++i) {
        Pose pose = test::pose_on_path(20 * i);
        pose.translation *= 100.0;
        written.poses.push_back({1305031233525708000 + 33'333'333LL * i, {pose, {}}});
    }
    write_tum_trajectory(folder / "poses.txt", written);
    EXPECT_EQ(folder.entries(), 1) << "the file beside it must be gone";
    const Trajectory read = read_tum_trajectory(folder / "poses.txt");
    ASSERT_EQ(read.poses.size(), written.poses.size());
    for (std::size_t i = 0; i < read.poses.size(); ++i) {
        const Pose& a = written.poses[i].world_from_camera.pose;
        const Pose& b = read.poses[i].world_from_camera.pose;
        EXPECT_EQ(read.poses[i].time_ns, written.poses[i].time_ns);
        EXPECT_LT(glm::distance(a.translation, b.translation), 1e-9);
        EXPECT_LT(rotation_angle(a, b), 1e-9);
    }
}

TEST(Trajectory, NegativeTimesSurvive) {
    TemporaryFolder folder;
    write_tum_trajectory(folder / "poses.txt", {{{-500'000'000, {}}, {-1, {}}}, {}});
    const Trajectory read = read_tum_trajectory(folder / "poses.txt");
    EXPECT_EQ(read.poses.at(0).time_ns, -500'000'000);
    EXPECT_EQ(read.poses.at(1).time_ns, -1);
}

TEST(Trajectory, StampsKeepEveryDigit) {
    EXPECT_EQ(parse_time_ns("1305031233.525708"), 1305031233525708000);
    EXPECT_EQ(parse_time_ns("0.000000001"), 1);
    EXPECT_EQ(parse_time_ns("-1.5"), -1'500'000'000);
    EXPECT_EQ(parse_time_ns("7"), 7'000'000'000);
    for (const char* bad :
         {"", ".", "-", "1e9", "nan", "1403636579763555584", "1.2.3", "12a", "+1"})
        EXPECT_EQ(parse_time_ns(bad), std::nullopt) << bad;
}

TEST(Trajectory, RotationsNearlyOrthonormalBecomeSo) {
    const Pose exact = test::pose_on_path(40);
    Pose off = exact;
    off.rotation[0] *= 1.0 + 2e-4;
    off.rotation[1][2] += 1e-4;
    const CheckedPose checked = pose_from_rows(rows_of(off));
    ASSERT_TRUE(checked.usable()) << checked.fault;
    const glm::dmat3& r = checked.pose.rotation;
    const glm::dmat3 rest = glm::transpose(r) * r - glm::dmat3(1.0);
    for (int c = 0; c < 3; ++c)
        EXPECT_LT(glm::length(rest[c]), 1e-14);            // a few roundings
    EXPECT_LT(rotation_angle(checked.pose, exact), 2e-4);  // the disturbance itself
}

TEST(Trajectory, WhatIsNoRigidMotionIsUnusable) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    auto rows = rows_of(test::pose_on_path(7));
    const auto fault_with = [&](std::size_t place, double value) {
        auto changed = rows;
        changed[place] = value;
        return pose_from_rows(changed).fault;
    };
    EXPECT_THAT(fault_with(3, nan), HasSubstr("not finite"));
    EXPECT_THAT(fault_with(5, -infinity), HasSubstr("not finite"));
    EXPECT_THAT(fault_with(15, 2), HasSubstr("last row"));
    EXPECT_THAT(fault_with(0, 1.2), HasSubstr("determinant"));
    Pose mirrored;
    mirrored.rotation[1][1] = -1;
    EXPECT_THAT(pose_from_rows(rows_of(mirrored)).fault, HasSubstr("determinant -1"));
    Pose sheared;  // determinant 1 all the same
    sheared.rotation[1][0] = 0.3;
    EXPECT_THAT(pose_from_rows(rows_of(sheared)).fault, HasSubstr("orthonormal"));
    const std::array<double, 7> zero{1, 2, 3, 0, 0, 0, 0}, close{1, 2, 3, 0, 0, 0, 1.0009},
        lost{nan, 0, 0, 0, 0, 0, 1};
    EXPECT_THAT(pose_from_quaternion(zero).fault, HasSubstr("length 0"));
    EXPECT_TRUE(pose_from_quaternion(close).usable());
    EXPECT_FALSE(pose_from_quaternion(lost).usable());
}

TEST(Trajectory, InterpolationEndsWhereTheDataEnd) {
    Trajectory trajectory;
    const std::int64_t second = 1'000'000'000;
    for (const std::int64_t t : {0 * second, second / 20, second})
        trajectory.poses.push_back({t, {{glm::dmat3(1.0), {double(t), 0, 0}}, {}}});
    EXPECT_NEAR(interpolate_at(trajectory, second / 40)->pose.translation.x, second / 40.0, 1e-6);
    EXPECT_TRUE(interpolate_at(trajectory, -second / 2000).has_value()) << "rounded stamps";
    EXPECT_TRUE(interpolate_at(trajectory, second).has_value());
    EXPECT_FALSE(interpolate_at(trajectory, second / 2).has_value()) << "a gap of 0.95 s";
    EXPECT_FALSE(interpolate_at(trajectory, -second / 100).has_value());
    EXPECT_FALSE(interpolate_at(trajectory, 2 * second).has_value());
    EXPECT_FALSE(interpolate_at({}, 0).has_value());
    trajectory.poses[1].world_from_camera.fault = "broken";
    EXPECT_EQ(interpolate_at(trajectory, second / 40)->fault, "broken");
}

TEST(Pairing, TakesTheClosestFirstAndEachOnce) {
    const std::vector<std::int64_t> a{0, 10, 30, 100}, b{9, 12, 28, 60};
    // 10-9 is closer than 10-12 and 0-9; 0 is then left with 12, too far; 100 is far from all.
    const auto pairs = pair_by_time(a, b, 10);
    EXPECT_THAT(pairs, ElementsAre(TimePair{1, 0}, TimePair{2, 2}));
    EXPECT_THAT(pair_by_time(a, b, 12),
                ElementsAre(TimePair{0, 1}, TimePair{1, 0}, TimePair{2, 2}));
    EXPECT_TRUE(pair_by_time({}, b, 10).empty());
}

TEST(Pairing, DoesNotDependOnTheOrderOfTheStreams) {
    const std::vector<std::int64_t> a{30, 0, 10}, b{28, 9, 12};
    EXPECT_THAT(pair_by_time(a, b, 10), ElementsAre(TimePair{0, 0}, TimePair{2, 1}));
}

}  // namespace
}  // namespace inlay
