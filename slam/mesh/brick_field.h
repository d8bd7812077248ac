// The distance field in and around one brick, copied together: reading it needs no hash.
#pragma once

#include "slam/volume/sample_volume.h"

#include <array>
#include <cstdint>

namespace inlay {

/// Voxels a side: those of the brick, one before and three after it, which is what gradients at the
/// corners of the brick's triangles reach.
constexpr int field_side = 1 + brick_side + 3;
constexpr std::size_t field_entries = std::size_t(field_side) * field_side * field_side;

/// What is said of the cube between eight voxels.
constexpr std::uint8_t cell_known = 1;    // all eight were seen
constexpr std::uint8_t cell_crossed = 2;  // and some, but not all, have distances below 0

/// Entry (k * field_side + j) * field_side + i is voxel first + (i, j, k), and the cell from there.
/// Cells that begin at the last voxels of a row, column or layer mean nothing.
struct BrickField {
    template <class Value>
    using Plane = std::array<Value, field_entries>;

    static constexpr std::array<int, 3> stride{1, field_side, (field_side * field_side)};

    glm::ivec3 first{0};  // lattice position
    Plane<float> distance{};
    Plane<std::uint8_t> cell{};             // bits
    std::array<const Brick*, 27> bricks{};  // those that meet the brick, and itself; x fastest

    /// The entry of a lattice position.
    std::size_t entry(const glm::ivec3& v) const {
        const glm::ivec3 at = v - first;
        const int number = at.x + at.y * stride[1] + at.z * stride[2];
        return std::size_t(number);
    }
    /// Where the eight voxels from a lattice position on are stored, x fastest.
    std::array<VoxelPlace, 8> places(const glm::ivec3& v) const;
};

BrickField brick_field(const VoxelVolume& volume, const Brick& brick);

}  // namespace inlay
