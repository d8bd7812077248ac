// Views and depth images that break trackers, and the same bytes for any number of threads.
#include "recordings/base/parallel.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/reconstruct_recording.h"
#include "slam/mesh/extract_mesh.h"
#include "tests/support/floating_point_traps.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

namespace inlay {
namespace {

/// Makes NaN, or divides by zero.
constexpr int trapped = FE_INVALID | FE_DIVBYZERO;

/// One thread, so that the traps cover all of the work.
class SlamTraps : public ::testing::Test {
protected:
    void SetUp() override { set_thread_count(1); }
    void TearDown() override { set_thread_count(0); }
};

bool finite(const SurfaceMap& map) {
    for (std::size_t i = 0; i < map.position.pixels.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            if (!std::isfinite(map.position.pixels[i][k])) return false;
            if (!std::isfinite(map.normal.pixels[i][k])) return false;
        }
        if (map.confidence.pixels[i] < 0 || map.confidence.pixels[i] > 1) return false;
    }
    return true;
}

bool same_pose(const Pose& a, const Pose& b) { return std::memcmp(&a, &b, sizeof(Pose)) == 0; }

Pose swaying(int i) {
    return test::posed({0.02 * std::sin(0.3 * i), 0.02 * i, 0}, {0.01 * i, 0, 0});
}

/// Depth images of a room with every kind of value a file may hold.
RgbdFrame damaged_frame(int index, const Pose& pose) {
    RgbdFrame frame = test::room_frame(index, pose, 1);
    const std::vector<float> values{NAN,
                                    INFINITY,
                                    -INFINITY,
                                    0.0f,
                                    -0.0f,
                                    -3.0f,
                                    1e30f,
                                    std::numeric_limits<float>::max(),
                                    std::numeric_limits<float>::denorm_min()};
    for (std::size_t i = 0; i < frame.depth.pixels.size(); i += 5) {
        frame.depth.pixels[i] = values[(i / 5) % values.size()];
    }
    return frame;
}

TEST_F(SlamTraps, ABadDepthValueNeverReachesTheModel) {
    const test::FloatingPointTraps traps(trapped);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    for (int i = 0; i < 6; ++i) {
        const SlamStep step = advance_slam(state, damaged_frame(i, swaying(i)), settings, {});
        EXPECT_TRUE(finite(step.surface));
        EXPECT_EQ(step.tracking.status, TrackingStatus::tracked) << i;
        EXPECT_LT(glm::length(step.tracking.world_from_camera.translation - swaying(i).translation),
                  0.01);  // a voxel
    }
    for (const Brick& brick : state.volume.bricks) {
        for (std::size_t i = 0; i < brick_voxels; ++i) {
            const float distance = brick.distance[i], weight = brick.weight[i];
            ASSERT_TRUE(weight >= 0 && weight <= settings.fusion.max_weight);
            if (weight == 0) {
                ASSERT_EQ(distance, unknown_distance);
            } else {
                ASSERT_TRUE(distance >= -1 && distance <= 1);
            }
        }
    }
    for (const glm::vec3& n : extract_mesh(state.volume).normals) {
        ASSERT_NEAR(glm::length(n), 1, 1e-4);
    }
}

TEST_F(SlamTraps, FramesWithoutDepthAreLostAndHarmless) {
    const test::FloatingPointTraps traps(trapped);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    RgbdFrame empty = test::room_frame(0, Pose{});
    std::fill(empty.depth.pixels.begin(), empty.depth.pixels.end(), 0.0f);
    EXPECT_TRUE(finite(advance_slam(state, empty, settings, {}).surface));
    advance_slam(state, test::room_frame(1, Pose{}), settings, {});
    const std::size_t bricks = state.volume.bricks.size();
    const SlamStep lost = advance_slam(state, empty, settings, {});
    EXPECT_EQ(lost.tracking.status, TrackingStatus::lost);
    for (const float confidence : lost.surface.confidence.pixels)
        EXPECT_EQ(confidence, 0);
    EXPECT_TRUE(lost.surface.has_surface(80, 60));
    EXPECT_EQ(state.volume.bricks.size(), bricks);
    const SlamStep back = advance_slam(state, test::room_frame(3, Pose{}), settings, {});
    EXPECT_EQ(back.tracking.status, TrackingStatus::tracked);
}

TEST_F(SlamTraps, ASinglePlaneMovesNothingThatItCannotTell) {
    const test::FloatingPointTraps traps(trapped);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    RgbdFrame frame = test::room_frame(0, Pose{});
    for (int i = 0; i < 10; ++i) {
        for (std::size_t p = 0; p < frame.depth.pixels.size(); ++p) {
            const float noise = uniform({1, std::uint32_t(i), std::uint32_t(p), 0}, 0) - 0.5f;
            frame.depth.pixels[p] = 1.0f + 0.01f * float(i) + 0.004f * noise;
        }
        const SlamStep step = advance_slam(state, frame, settings, {});
        const Pose& pose = step.tracking.world_from_camera;
        // The plane goes away by 1 cm a frame: the camera goes back, and must not slide along it.
        // Noise in the first frames' normals looks like structure, of less than a voxel.
        EXPECT_NEAR(pose.translation.z, -0.01 * i, 0.002);
        EXPECT_LT(glm::length(glm::dvec2(pose.translation)), 0.01);
        EXPECT_LT(rotation_angle(pose, Pose{}), 0.005);
    }
}

TEST_F(SlamTraps, ALostCameraIsFoundWhenAnOldViewReturns) {
    const test::FloatingPointTraps traps(trapped);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    for (int i = 0; i < 25; ++i) {
        advance_slam(state, test::room_frame(i, swaying(i), 1), settings, {});
    }
    RgbdFrame unknown = test::room_frame(25, Pose{});
    for (std::size_t i = 0; i < unknown.depth.pixels.size(); ++i) {
        unknown.depth.pixels[i] = 0.5f + 0.4f * std::sin(float(i % 160) / 9.0f);
    }
    const Pose last_good = state.model->world_from_camera;
    for (int i = 0; i < 3; ++i) {
        const SlamStep step = advance_slam(state, unknown, settings, {});
        ASSERT_EQ(step.tracking.status, TrackingStatus::lost);
        EXPECT_TRUE(same_pose(step.tracking.world_from_camera, last_good));
    }
    // Back near the first view, half a radian and a quarter metre away from the last good one.
    const SlamStep back = advance_slam(state, test::room_frame(30, swaying(1), 1), settings, {});
    EXPECT_EQ(back.tracking.status, TrackingStatus::tracked);
    EXPECT_LT(glm::length(back.tracking.world_from_camera.translation - swaying(1).translation),
              0.01);
    EXPECT_LT(rotation_angle(back.tracking.world_from_camera, swaying(1)), 0.01);
}

TEST_F(SlamTraps, ScenesFarFromTheOriginAreTrackedAsWell) {
    const test::FloatingPointTraps traps(trapped);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    const Pose far = test::posed({1, -2, 0.5}, {100, -50, 80});
    for (int i = 0; i < 5; ++i) {
        RgbdFrame frame = test::room_frame(i, swaying(i), 1);
        frame.recorded_world_from_camera = far * swaying(i);
        const Pose pose = advance_slam(state, frame, settings, {}).tracking.world_from_camera;
        EXPECT_LT(glm::length(pose.translation - (far * swaying(i)).translation), 0.005);
    }
}

struct Outcome {
    std::vector<Pose> poses;
    SurfaceMap surface;
    TriangleMesh mesh;
    std::vector<Brick> bricks;
};

Outcome run_with(int threads) {
    set_thread_count(threads);
    const SlamSettings settings;
    SlamState state = start_slam(settings);
    Outcome run;
    for (int i = 0; i < 8; ++i) {
        const SlamStep step = advance_slam(state, test::room_frame(i, swaying(i), 1), settings, {});
        run.poses.push_back(step.tracking.world_from_camera);
        run.surface = step.surface;
    }
    run.mesh = extract_mesh(state.volume);
    run.bricks.assign(state.volume.bricks.begin(), state.volume.bricks.end());
    set_thread_count(0);
    return run;
}

template <class Value>
bool same_bytes(const std::vector<Value>& a, const std::vector<Value>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Value)) == 0;
}

/// Bricks have padding, which means nothing.
bool same_bricks(const std::vector<Brick>& a, const std::vector<Brick>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Brick& p, const Brick& q) {
        return p.key == q.key && p.distance == q.distance && p.weight == q.weight &&
               p.color == q.color && p.color_weight == q.color_weight;
    });
}

TEST(SlamThreads, AReconstructionIsTheSameForOneAndThreeThreads) {
    const FrameSource source =
        test::frames_from(10, [](int i) { return test::room_frame(i, swaying(i), 1); });
    const auto run = [&](int threads) {
        set_thread_count(threads);
        Reconstruction result = reconstruct_recording(source, accurate_slam(), PoseSource::tracked,
                                                      [](int) { return true; });
        set_thread_count(0);
        return result;
    };
    const Reconstruction one = run(1), three = run(3);
    for (std::size_t i = 0; i < one.frames.size(); ++i)
        EXPECT_TRUE(same_pose(one.frames[i].tracking.world_from_camera,
                              three.frames[i].tracking.world_from_camera));
    EXPECT_TRUE(same_bricks({one.volume.bricks.begin(), one.volume.bricks.end()},
                            {three.volume.bricks.begin(), three.volume.bricks.end()}));
}

TEST(SlamThreads, OneTwoAndFiveThreadsGiveTheSameBytes) {
    const Outcome one = run_with(1);
    for (const int threads : {2, 5}) {
        const Outcome other = run_with(threads);
        EXPECT_TRUE(same_bytes(one.poses, other.poses));
        EXPECT_TRUE(same_bytes(one.surface.position.pixels, other.surface.position.pixels));
        EXPECT_TRUE(same_bytes(one.surface.normal.pixels, other.surface.normal.pixels));
        EXPECT_TRUE(same_bytes(one.mesh.positions, other.mesh.positions));
        EXPECT_TRUE(same_bytes(one.mesh.triangles, other.mesh.triangles));
        EXPECT_TRUE(same_bytes(one.mesh.colors, other.mesh.colors));
        EXPECT_TRUE(same_bricks(one.bricks, other.bricks));
    }
}

}  // namespace
}  // namespace inlay
