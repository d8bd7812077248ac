#include "slam/volume/voxel_volume.h"

namespace inlay {

const Brick* find_brick(const VoxelVolume& volume, const glm::ivec3& key) {
    const int number = volume.index.find(key);
    return number == BrickIndex::absent ? nullptr : &volume.bricks[std::size_t(number)];
}

int ensure_brick(VoxelVolume& volume, const glm::ivec3& key) {
    const int known = volume.index.find(key);
    if (known != BrickIndex::absent) return known;
    const int number = int(volume.bricks.size());
    volume.bricks.emplace_back();
    volume.bricks.back().key = key;
    volume.keys.push_back(key);
    volume.index.insert(key, number);
    return number;
}

}  // namespace inlay
