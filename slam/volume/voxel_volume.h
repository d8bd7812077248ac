// VoxelVolume: a truncated signed distance field in bricks of 8 x 8 x 8 voxels, found by hashing.
#pragma once

#include "slam/volume/brick_index.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

namespace inlay {

constexpr int brick_side = 8;  // voxels
constexpr int brick_voxels = brick_side * brick_side * brick_side;

/// The distance of a voxel that was never seen. Distances that are known end at 1.
constexpr float unknown_distance = 2;
inline bool is_known(float distance) { return distance < 1.5f; }

/// Eight voxels a side, a plane of numbers for each property, so that rows of eight are read and
/// written at once. Voxel (i, j, k) is entry (k * 8 + j) * 8 + i.
struct Brick {
    template <class Value>
    using Plane = std::array<Value, brick_voxels>;

    Brick() { distance.fill(unknown_distance); }

    glm::ivec3 key{0};                  // in bricks: its first voxel is 8 * key
    alignas(32) Plane<float> distance;  // of the truncation, -1..1; positive on the free side
    alignas(32) Plane<float> weight{};  // observations; 0: never seen
    std::array<Plane<std::uint16_t>, 3> color{};  // linear, 65535 = 1
    Plane<std::uint16_t> color_weight{};          // observations of the color; 0: none
};

/// The fused model. Voxel v has its centre at v * voxel_size (world, m). Bricks are numbered in the
/// order in which they were allocated.
struct VoxelVolume {
    float voxel_size = 0.008f;     // m
    float truncation = 0.032f;     // m, half-width of the signed-distance band
    std::deque<Brick> bricks;      // addresses stay valid while it grows
    std::vector<glm::ivec3> keys;  // of all bricks, close together: going over them is fast
    BrickIndex index;
    std::size_t most_bricks = 1 << 20;  // then it takes no more
    std::size_t refused = 0;            // times that a brick found no room
};

inline glm::ivec3 brick_of(const glm::ivec3& voxel) {
    return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
}

inline int slot_in_brick(const glm::ivec3& voxel) {
    return ((voxel.z & 7) << 6) | ((voxel.y & 7) << 3) | (voxel.x & 7);
}

/// The brick at `key`, or null.
const Brick* find_brick(const VoxelVolume& volume, const glm::ivec3& key);

/// The number of the brick at `key`, which is allocated (empty) if it is not there, whatever
/// `most_bricks` says.
int ensure_brick(VoxelVolume& volume, const glm::ivec3& key);

}  // namespace inlay
