// VoxelVolume: a truncated signed distance field in bricks of 8 x 8 x 8 voxels, found by hashing.
#pragma once

#include "recordings/base/color.h"
#include "slam/volume/brick_index.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <deque>

namespace inlay {

constexpr int brick_side = 8;  // voxels
constexpr int brick_voxels = brick_side * brick_side * brick_side;

struct Voxel {
    float distance = 1;                    // of the truncation, -1..1; positive on the free side
    float weight = 0;                      // observations; 0: never seen
    std::array<std::uint16_t, 3> color{};  // linear, 65535 = 1
    std::uint16_t color_weight = 0;        // observations of the color; 0: none
};

/// Voxel (i, j, k) of a brick is voxels[(k * 8 + j) * 8 + i].
struct Brick {
    glm::ivec3 key{0};  // in bricks: its first voxel is 8 * key
    std::array<Voxel, brick_voxels> voxels;
};

/// The fused model. Voxel v has its centre at v * voxel_size (world, m). Bricks are numbered in the
/// order in which they were allocated.
struct VoxelVolume {
    float voxel_size = 0.008f;  // m
    float truncation = 0.032f;  // m, half-width of the signed-distance band
    std::deque<Brick> bricks;   // addresses stay valid while it grows
    BrickIndex index;
};

inline glm::ivec3 brick_of(const glm::ivec3& voxel) {
    return {voxel.x >> 3, voxel.y >> 3, voxel.z >> 3};
}

inline int slot_in_brick(const glm::ivec3& voxel) {
    return ((voxel.z & 7) << 6) | ((voxel.y & 7) << 3) | (voxel.x & 7);
}

/// The brick at `key`, or null.
const Brick* find_brick(const VoxelVolume& volume, const glm::ivec3& key);

/// The number of the brick at `key`, which is allocated (empty) if it is not there.
int ensure_brick(VoxelVolume& volume, const glm::ivec3& key);

/// The voxel at lattice position `voxel`, or null where nothing is allocated.
const Voxel* find_voxel(const VoxelVolume& volume, const glm::ivec3& voxel);

}  // namespace inlay
