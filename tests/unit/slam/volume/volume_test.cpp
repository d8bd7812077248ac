// The volume: finding bricks, fusing depth, and seeing the fused surface again.
#include "recordings/base/check.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/volume/fuse_depth.h"
#include "slam/volume/raycast_volume.h"
#include "slam/volume/sample_volume.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace inlay {
namespace {

using test::small_lens;

TEST(BrickIndex, FindsWhatWasInserted) {
    VoxelVolume volume;
    for (int i = 0; i < 5000; ++i) {
        const glm::ivec3 key(i % 17 - 8, (i / 17) % 17 - 8, i / 289 - 8);
        EXPECT_EQ(ensure_brick(volume, key), i);
    }
    for (int i = 0; i < 5000; i += 7)
        EXPECT_EQ(volume.index.find(volume.bricks[std::size_t(i)].key), i);
    EXPECT_EQ(volume.index.find({100, 0, 0}), BrickIndex::absent);
    EXPECT_EQ(find_brick(volume, brick_of({-9 * 8, 0, 0})), nullptr);
}

TEST(BrickIndex, VoxelsBelowZeroBelongToTheBrickBelowZero) {
    EXPECT_EQ(brick_of({-1, -8, -9}), glm::ivec3(-1, -1, -2));
    EXPECT_EQ(slot_in_brick({-1, -8, -9}), 7 * 64 + 0 * 8 + 7);
}

/// The volume after one exact view of the room, and what is seen of it.
SurfaceMap seen_after_fusing(const Pose& from, const Pose& at, const FusionSettings& settings) {
    VoxelVolume volume = make_volume(settings);
    fuse_depth(volume, test::room_depth(small_lens(), from), {}, small_lens(), from, settings);
    return raycast_volume(volume, small_lens(), at, {});
}

TEST(RaycastVolume, ShowsTheFusedSurfaceWithinAFractionOfAVoxel) {
    const Pose pose = test::posed({0.1, -0.2, 0.05}, {0.1, 0.05, -0.1});
    const FusionSettings settings;
    const SurfaceMap seen = seen_after_fusing(pose, pose, settings);
    std::vector<double> errors;
    for (const glm::vec3& p : seen.position.pixels) {
        if (p.z > 0) errors.push_back(test::distance_from_surface(pose * glm::dvec3(p)));
    }
    ASSERT_GT(errors.size(), 0.9 * seen.position.pixels.size());
    std::sort(errors.begin(), errors.end());
    // A plane's distance is linear, so only the nearest-pixel footprint (1.4 cm at 2 m, on curved
    // parts) and the clamp at the truncation bend it: a tenth of a voxel for most, one at edges.
    EXPECT_LT(errors[errors.size() / 2], 0.1 * settings.voxel_size);
    EXPECT_LT(errors[errors.size() * 95 / 100], 0.5 * settings.voxel_size);
}

TEST(RaycastVolume, NormalsOfAPlaneAreThePlanes) {
    const Lens lens = small_lens();
    const FusionSettings settings;
    VoxelVolume volume = make_volume(settings);
    fuse_depth(volume, Image<float>(lens.width, lens.height, 1.0f), {}, lens, Pose{}, settings);
    const SurfaceMap seen = raycast_volume(volume, lens, Pose{}, {});
    for (int y = 10; y < lens.height - 10; ++y) {
        for (int x = 10; x < lens.width - 10; ++x) {
            ASSERT_TRUE(seen.has_surface(x, y));
            // 1e-5: rounding; the field of a plane is linear, and so is its interpolation.
            EXPECT_NEAR(seen.position(x, y).z, 1.0f, 1e-5);
            EXPECT_LT(glm::length(seen.normal(x, y) - glm::vec3(0, 0, -1)), 1e-3);
        }
    }
}

TEST(RaycastVolume, ABallSeenFromTheSideIsStillABall) {
    const Pose side = test::posed({0, 0.15, 0}, {-0.25, 0, 0.05});
    const SurfaceMap seen = seen_after_fusing(Pose{}, side, {});
    const test::Ball& ball = test::balls[0];
    std::vector<double> angles;
    for (std::size_t i = 0; i < seen.position.pixels.size(); ++i) {
        const glm::dvec3 out = side * glm::dvec3(seen.position.pixels[i]) - ball.centre;
        if (std::abs(glm::length(out) - ball.radius) > 0.002) continue;
        if (glm::normalize(out).z > -0.6) continue;  // seen steeply when it was fused
        const glm::dvec3 n = side.rotation * glm::dvec3(seen.normal.pixels[i]);
        angles.push_back(std::acos(std::min(1.0, glm::dot(n, glm::normalize(out)))));
    }
    ASSERT_GT(angles.size(), 300U);
    std::sort(angles.begin(), angles.end());
    // Voxels near each other take their distances from the tangent planes of pixels 1 cm apart,
    // 1/40 rad on this ball; a difference of the field over two voxels sees a facet's step or not.
    EXPECT_LT(angles[angles.size() / 2], 0.025);
    EXPECT_LT(angles[angles.size() * 98 / 100], 0.1);
}

TEST(RaycastVolume, TheBackOfASurfaceIsNotSeen) {
    const Lens lens = small_lens();
    VoxelVolume volume = make_volume({});
    fuse_depth(volume, Image<float>(lens.width, lens.height, 1.0f), {}, lens, Pose{}, {});
    Pose behind;
    behind.rotation = glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1);
    behind.translation = {0, 0, 2};
    for (const glm::vec3& p : raycast_volume(volume, lens, behind, {}).position.pixels) {
        EXPECT_EQ(p.z, 0);
    }
}

TEST(RaycastVolume, SeesThroughABentLensWhereTheLensSees) {
    Lens bent = small_lens();
    bent.k1 = 0.2, bent.k2 = -0.3, bent.p1 = 0.003;
    const FusionSettings settings;
    VoxelVolume volume = make_volume(settings);
    fuse_depth(volume, test::room_depth(bent, Pose{}), {}, bent, Pose{}, settings);
    const SurfaceMap seen = raycast_volume(volume, bent, Pose{}, {});
    for (int y = 0; y < bent.height; y += 7) {
        for (int x = 0; x < bent.width; x += 7) {
            if (!seen.has_surface(x, y)) continue;  // 1e-3 px: positions are floats
            EXPECT_LT(glm::length(project(bent, seen.position(x, y)) - glm::dvec2(x, y)), 1e-3);
        }
    }
    EXPECT_TRUE(seen.has_surface(80, 60));
}

TEST(FuseDepth, NoiseAveragesOut) {
    const Pose pose;
    const FusionSettings settings;
    const auto noise_after = [&](int frames) {
        VoxelVolume volume = make_volume(settings);
        for (int i = 0; i < frames; ++i) {
            const RgbdFrame frame = test::room_frame(i, pose, 1);
            fuse_depth(volume, frame.depth, {}, frame.lens, pose, settings);
        }
        const SurfaceMap seen = raycast_volume(volume, small_lens(), pose, {});
        std::vector<double> errors;
        for (const glm::vec3& p : seen.position.pixels) {
            if (p.z > 0) errors.push_back(test::distance_from_surface(glm::dvec3(p)));
        }
        std::sort(errors.begin(), errors.end());
        return errors[errors.size() / 2];
    };
    // Independent noise falls with the square root of the observations: to 1/4 after 16; half of
    // that gain is asked for, since the weights are not uniform.
    EXPECT_LT(noise_after(16), 0.5 * noise_after(1));
}

TEST(FuseDepth, ASurfaceThatWentAwayIsCarvedOut) {
    const Lens lens = small_lens();
    const FusionSettings settings;
    VoxelVolume volume = make_volume(settings);
    fuse_depth(volume, Image<float>(lens.width, lens.height, 1.0f), {}, lens, Pose{}, settings);
    const Image<float> farther(lens.width, lens.height, 1.5f);
    for (int i = 0; i < 4; ++i)
        fuse_depth(volume, farther, {}, lens, Pose{}, settings);
    const SurfaceMap seen = raycast_volume(volume, lens, Pose{}, {});
    EXPECT_NEAR(seen.position(80, 60).z, 1.5, 1e-3);
}

TEST(VolumeColor, IsTheColorThatWasFused) {
    const RgbdFrame frame = test::room_frame(0, Pose{});
    VoxelVolume volume = make_volume({});
    fuse_depth(volume, frame.depth, frame.color, frame.lens, Pose{}, {});
    const glm::vec3 p(Pose{} * (double(frame.depth(40, 70)) * unproject(frame.lens, {40, 70})));
    const auto color = volume_color(volume, p);
    ASSERT_TRUE(color.has_value());
    const Rgb expected = decode(EncodedRgb{200, 100, 50});
    EXPECT_LT(glm::length(*color - expected), 3.0f / 65535);  // stored in 16 bits
    EXPECT_FALSE(volume_color(volume, {0, 0, 0.2f}).has_value());
}

TEST(VolumeColor, IsKeptAtOneExposureAndOnlyRaisedByClippedPixels) {
    RgbdFrame frame = test::room_frame(0, Pose{});
    const SurfaceMap seen = surface_from_depth(frame.depth, frame.lens, Pose{});
    const glm::vec3 p(double(frame.depth(40, 70)) * unproject(frame.lens, {40, 70}));
    const Rgb dark = decode(EncodedRgb{200, 100, 50});
    VoxelVolume volume = make_volume({});
    for (const float gain : {1.0f, 2.0f, 4.0f}) {  // red clips at 2 and 4, green at 4
        frame.color.pixels.assign(frame.color.pixels.size(), encode(gain * dark));
        fuse_surface(volume, seen, {frame.color, frame.lens, Pose{}, Rgb(gain)}, {});
    }
    const Rgb color = *volume_color(volume, p);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(color[c], dark[c], 0.004f);  // bytes of brighter photographs, rounded
}

TEST(FusionSettings, RefuseWhatCannotWork) {
    FusionSettings settings;
    settings.truncation = settings.voxel_size;
    EXPECT_THROW(make_volume(settings), Error);
}

}  // namespace
}  // namespace inlay
