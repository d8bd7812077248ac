// Eight points at a time give what one at a time gives.
#include "slam/volume/brick_grid.h"

#include "recordings/base/random.h"
#include "slam/volume/sample_volume.h"

#include <gtest/gtest.h>

#include <numeric>

namespace inlay {
namespace {

constexpr int bricks_a_side = 3;

std::uint32_t number_of(const glm::ivec3& v) {
    return std::uint32_t(v.x + 64) + 128 * std::uint32_t(v.y + 64) +
           16384 * std::uint32_t(v.z + 64);
}

/// Bricks around the origin whose voxels have `distance`, and are unknown where that says so.
template <class DistanceAt>
VoxelVolume volume_of(const DistanceAt& distance) {
    VoxelVolume volume;
    for (int i = 0; i < bricks_a_side * bricks_a_side * bricks_a_side; ++i) {
        const glm::ivec3 key = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 2;  // below and above zero
        Brick& brick = volume.bricks[std::size_t(ensure_brick(volume, key))];
        for (int slot = 0; slot < brick_voxels; ++slot) {
            const glm::ivec3 v = key * brick_side + glm::ivec3(slot & 7, slot >> 3 & 7, slot >> 6);
            brick.distance[std::size_t(slot)] = distance(v);
            brick.weight[std::size_t(slot)] = is_known(distance(v)) ? 2.0f : 0.0f;
        }
    }
    return volume;
}

BrickGrid grid_of(const VoxelVolume& volume) {
    std::vector<int> all(volume.bricks.size());
    std::iota(all.begin(), all.end(), 0);
    return {volume, all};
}

/// A random point (voxels, lattice coordinates) in and around the bricks.
glm::vec3 point(std::uint32_t number) {
    const SampleKey key{3, 0, number, 0};
    return glm::vec3(uniform(key, 0), uniform(key, 1), uniform(key, 2)) * 34.0f - 21.0f;
}

Vectors eight_points(const BrickGrid& grid, std::uint32_t first) {
    return gathered(
        [&](auto lane) { return point(first + std::uint32_t(lane)) - glm::vec3(grid.origin()); });
}

TEST(BrickGrid, DistancesAreThoseOfTheSampler) {
    const VoxelVolume volume = volume_of([](const glm::ivec3& v) {
        return 2 * uniform({1, 0, number_of(v), 0}, 0) - 1;
    });
    const BrickGrid grid = grid_of(volume);
    VolumeSampler sampler(volume);
    int known = 0;
    for (std::uint32_t i = 0; i < 4000; i += lane_count) {
        const Floats distance = grid.distance(eight_points(grid, i));
        for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
            const float expected = sampler.distance(point(i + lane));
            if (!is_known(expected)) continue;
            ++known;
            EXPECT_NEAR(distance[lane], expected, 1e-5);  // coordinates up to 32 as floats
        }
    }
    EXPECT_GT(known, 1000);
}

TEST(BrickGrid, UnknownVoxelsDoNotBendALinearField) {
    const glm::vec3 slope(0.01f, -0.02f, 0.015f);
    const auto exact = [&](const glm::vec3& p) { return glm::dot(slope, p) + 0.1f; };
    const VoxelVolume volume = volume_of([&](const glm::ivec3& v) {
        const bool seen = uniform({2, 0, number_of(v), 0}, 0) > 0.2f;
        return seen ? exact(glm::vec3(v)) : unknown_distance;
    });
    const BrickGrid grid = grid_of(volume);
    int known = 0;
    for (std::uint32_t i = 0; i < 4000; i += lane_count) {
        const Vectors at = eight_points(grid, i);
        const Floats distance = grid.distance(at);
        const Vectors gradient = grid.gradient(at);
        for (std::uint32_t lane = 0; lane < lane_count; ++lane) {
            if (!is_known(distance[lane])) continue;
            // A mean over known voxels is taken up to a voxel off.
            EXPECT_NEAR(distance[lane], exact(point(i + lane)), 0.03f);
            if (gradient.x[lane] == 0) continue;
            ++known;
            EXPECT_NEAR(gradient.x[lane], slope.x, 1e-5);  // rounding of differences
            EXPECT_NEAR(gradient.y[lane], slope.y, 1e-5);
            EXPECT_NEAR(gradient.z[lane], slope.z, 1e-5);
        }
    }
    EXPECT_GT(known, 500);
}

TEST(BrickGrid, AroundTheBricksThereIsNothing) {
    const VoxelVolume volume = volume_of([](const glm::ivec3&) { return 0.5f; });
    const BrickGrid grid = grid_of(volume);
    for (const glm::vec3& p : {glm::vec3(-500, 3, 2), glm::vec3(4, 900, 2), glm::vec3(1, 2, 12)}) {
        const glm::vec3 q = p - glm::vec3(grid.origin());
        EXPECT_EQ(grid.nearest_distance({q.x, q.y, q.z})[0], absent_distance);
        EXPECT_FALSE(is_known(grid.distance({q.x, q.y, q.z})[0]));
        EXPECT_EQ(grid.nearest_weight(q), 0);
    }
    const glm::vec3 inside = glm::vec3(-3, -2, 1) - glm::vec3(grid.origin());
    EXPECT_EQ(grid.nearest_weight(inside), 2);
}

}  // namespace
}  // namespace inlay
