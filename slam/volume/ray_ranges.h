// How far along z the bricks of a volume lie, in each direction: where rays need not look.
#pragma once

#include "recordings/base/pose.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/voxel_volume.h"

#include <vector>

namespace inlay {

/// Bounds of z over the bricks that a ray may meet.
struct ZRange {
    float nearest = 1e30f, farthest = 0;  // m, camera frame; empty if nearest > farthest
};

/// A coarse grid of ZRange over the view's rays.
struct RayRanges {
    Image<ZRange> cells;
    glm::vec2 lowest{0}, cells_per_unit{0};
    std::vector<int> bricks;  // numbers of those that a ray may meet, ascending

    const ZRange& of(const glm::vec3& ray) const {
        const glm::vec2 at = (glm::vec2(ray) - lowest) * cells_per_unit;
        return cells(glm::clamp(int(at.x), 0, cells.width - 1),
                     glm::clamp(int(at.y), 0, cells.height - 1));
    }
};

/// The ranges of a view; bricks nearer than `nearest` (m, along z, > 0) count as being there.
RayRanges ray_ranges(const VoxelVolume& volume, const CameraView& view,
                     const Pose& camera_from_world, float nearest);

}  // namespace inlay
