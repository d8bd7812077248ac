// BrickGrid: the bricks of a box as a dense table, and the distance field at eight points at a
// time.
#pragma once

#include "recordings/base/lanes.h"
#include "slam/volume/voxel_volume.h"

#include <span>
#include <vector>

namespace inlay {

/// What BrickGrid reads where no brick is allocated: unknown, and more than an unseen voxel.
constexpr float absent_distance = 3;

/// A table of some bricks of a volume, for loops that ask for voxel after voxel: they need no hash
/// and no test for absent bricks. It is surrounded by absent bricks, so that every point has a
/// voxel: one outside reads a voxel of the border. Points are in voxels from `origin`; they must
/// fit an int. Valid as long as the volume does not change.
class BrickGrid {
public:
    BrickGrid(const VoxelVolume& volume, std::span<const int> bricks);

    /// Lattice position of the grid's first voxel.
    const glm::ivec3& origin() const { return origin_; }

    /// Distances (of the truncation) of the voxels nearest to the points.
    Floats nearest_distance(const Vectors& p) const;
    /// Distances at the points, trilinear over those of the eight voxels around each that are
    /// known; unknown_distance where these have less than half of the weight.
    Floats distance(const Vectors& p) const;
    /// Its gradient per voxel: means of the rises from voxel to voxel over two voxels, of those
    /// that are known; 0 where these have less than half of the weight.
    Vectors gradient(const Vectors& p) const;
    /// The weight of the voxel nearest to a point.
    float nearest_weight(const glm::vec3& p) const;

private:
    /// Parts of the places of voxels in a row along an axis: in the table of bricks, in a brick.
    template <std::size_t Count>
    struct Axis {
        std::array<Ints, Count> brick, slot;
    };
    template <std::size_t Count>
    Axis<Count> axis(const Ints& low, int which) const;
    Floats read(const Ints& brick, const Ints& slot) const {
        const auto bricks = numbers_of(brick), slots = numbers_of(slot);
        return Floats([&](auto lane) {
            return table_[std::size_t(bricks[lane])]->distance[std::size_t(slots[lane])];
        });
    }

    glm::ivec3 origin_{0}, size_{0};  // voxels; bricks
    std::array<int, 3> stride_{};     // entries of the table to the next brick
    std::vector<const Brick*> table_;
};

}  // namespace inlay
