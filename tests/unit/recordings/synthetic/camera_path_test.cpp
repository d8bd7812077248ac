// Camera paths: they look where they should, pass through their keys, and move smoothly.
#include "recordings/synthetic/camera_path.h"

#include "recordings/base/check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

const glm::dvec3 up{0, 1, 0};

double distance(const Pose& a, const Pose& b) {
    return glm::length(a.translation - b.translation) + rotation_angle(a, b);
}

void expect_rigid(const Pose& pose) {
    const glm::dmat3 product = glm::transpose(pose.rotation) * pose.rotation;
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::length(product[i] - glm::dmat3(1.0)[i]), 0, 1e-12);  // rounding
    EXPECT_GT(glm::determinant(pose.rotation), 0);
}

std::vector<PathKey> some_keys() {
    return {{0.0, look_at({0, 1, 2}, {0, 0, 0}, up)},
            {1.0, look_at({1, 1, 2}, {0, 0, 0}, up)},
            {1.5, look_at({2, 1.5, 0}, {0, 0, 0}, up)},
            {4.0, look_at({1, 1, -2}, {0.5, 0, 0}, up)}};
}

TEST(LookAt, PutsTheTargetOnTheAxisAndUpUpwards) {
    const Pose world_from_camera = look_at({1, 2, 3}, {-1, 0.5, 0}, up);
    expect_rigid(world_from_camera);
    const glm::dvec3 target = inverse(world_from_camera) * glm::dvec3(-1, 0.5, 0);
    EXPECT_NEAR(target.x, 0, 1e-12);
    EXPECT_NEAR(target.y, 0, 1e-12);
    EXPECT_NEAR(target.z, std::sqrt(4 + 2.25 + 9), 1e-12);
    EXPECT_LT((inverse(world_from_camera).rotation * up).y, 0);  // image y points down
    EXPECT_NEAR((inverse(world_from_camera).rotation * up).x, 0, 1e-12);
}

TEST(LookAt, RefusesViewsWithoutAnUprightPicture) {
    EXPECT_THROW(look_at({0, 1, 0}, {0, 0, 0}, up), Error);
    EXPECT_THROW(look_at({1, 1, 1}, {1, 1, 1}, up), Error);
}

TEST(OrbitPath, KeepsItsDistanceAndItsTarget) {
    const Orbit orbit{.target = {0, 0.3, 0}, .start = {0, 1, 2}, .angle = 1.2, .period = 4};
    const CameraPath path = orbit_path(orbit);
    EXPECT_NEAR(distance(path(0), look_at(orbit.start, orbit.target, up)), 0, 1e-7);  // atan2
    for (double t = 0; t < 4; t += 0.1) {
        expect_rigid(path(t));
        const glm::dvec3 target = inverse(path(t)) * orbit.target;
        EXPECT_NEAR(glm::length(target - glm::dvec3(0, 0, std::hypot(0.7, 2.0))), 0, 1e-12);
    }
    EXPECT_NEAR(rotation_angle(path(0), path(4)), 0, 1e-7);  // and back again
    // at the far end it has gone the angle around the axis: a chord of 2 r sin(angle / 2)
    EXPECT_NEAR(glm::length(path(2).translation - orbit.start), 2 * 2 * std::sin(0.6), 1e-12);
}

TEST(KeyframePath, PassesThroughItsKeysAndRestsBeyondThem) {
    const CameraPath path = keyframe_path(some_keys());
    for (const PathKey& key : some_keys())
        EXPECT_NEAR(distance(path(key.time), key.world_from_camera), 0, 1e-7);  // atan2
    EXPECT_EQ(path(-5).translation, path(0).translation);
    EXPECT_EQ(path(99).translation, path(4).translation);
}

TEST(KeyframePath, IsRigidAndHasNoJumpInVelocity) {
    const CameraPath path = keyframe_path(some_keys());
    const double h = 1e-4;
    const auto velocity = [&](double t) {
        return (path(t + h).translation - path(t).translation) / h;
    };
    for (const double key : {0.0, 1.0, 1.5, 4.0})
        // one step before and after a key; acceleration is below 30 m/s^2 on this path
        EXPECT_LT(glm::length(velocity(key) - velocity(key - h)), 30 * h) << key;
    for (double t = -0.5; t < 4.5; t += 0.05)
        expect_rigid(path(t));
}

TEST(KeyframePath, DoesNotTurnTheLongWayRound) {
    std::vector<PathKey> keys;
    for (int i = 0; i < 40; ++i)  // more than a full turn in small steps
        keys.push_back({double(i), look_at({std::sin(0.3 * i), 0.5, std::cos(0.3 * i)}, {}, up)});
    const CameraPath path = keyframe_path(keys);
    for (double t = 0; t < 38.9; t += 0.1)
        EXPECT_LT(rotation_angle(path(t), path(t + 0.1)), 0.05);  // 0.03 on average
}

TEST(KeyframePath, RefusesKeysOutOfOrder) {
    EXPECT_THROW(keyframe_path({}), Error);
    EXPECT_THROW(keyframe_path({{1, {}}, {1, {}}}), Error);
}

TEST(HandHeld, ShakesAsMuchAsItSays) {
    const ShakeSettings settings{.translation = 0.01, .rotation = 0.02, .frequency = 1};
    const CameraPath path = hand_held([](double) { return Pose{}; }, settings);
    glm::dvec3 squares{0};
    double angles = 0;
    const int count = 60'000;  // 600 s
    for (int i = 0; i < count; ++i) {
        const Pose pose = path(0.01 * i);
        squares += pose.translation * pose.translation;
        angles += std::pow(rotation_angle(pose, Pose{}), 2);
    }
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(std::sqrt(squares[axis] / count), 0.01, 1e-4);  // sines over 600 periods: 1 %
    EXPECT_NEAR(std::sqrt(angles / count), 0.02 * std::sqrt(3.0), 4e-4);
}

TEST(HandHeld, IsSmoothAndDependsOnItsSeed) {
    const CameraPath steady = [](double) { return Pose{}; };
    const CameraPath path = hand_held(steady, {.seed = 1});
    // the fastest a sum of sines moves: amplitudes x frequencies, 0.13 m/s and 0.17 rad/s here
    for (double t = 0; t < 10; t += 0.01)
        EXPECT_LT(distance(path(t), path(t + 1e-3)), 1e-3 * std::sqrt(3.0) * (0.13 + 0.17));
    EXPECT_GT(distance(path(1), hand_held(steady, {.seed = 2})(1)), 1e-4);
    EXPECT_EQ(path(1).translation, hand_held(steady, {.seed = 1})(1).translation);
}

}  // namespace
}  // namespace inlay
