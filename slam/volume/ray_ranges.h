// How far along z the bricks of a volume lie, in each direction: where rays need not look.
#pragma once

#include "recordings/base/pose.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/voxel_volume.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace inlay {

/// Where along z (m, camera frame) there are bricks that a ray may meet.
struct ZRange {
    static constexpr float slice = 0.1f;  // m, thickness
    static constexpr int slices = 64;     // the last one goes on without end

    float nearest = 1e30f, farthest = 0;  // bounds; empty if nearest > farthest
    std::uint64_t occupied = 0;           // a bit for each slice

    static int slice_of(float z) { return std::clamp(int(z / slice), 0, slices - 1); }

    /// `z`, if its slice is occupied, else the beginning of the next one that is; 1e30 if none is.
    float occupied_from(float z) const {
        const int first = slice_of(z);
        const int ahead = std::countr_zero(occupied >> first);
        return ahead == 0 ? z : ahead < slices ? float(first + ahead) * slice : 1e30f;
    }
};

/// A coarse grid of ZRange over the view's rays.
struct RayRanges {
    Image<ZRange> cells;
    glm::vec2 lowest{0}, cells_per_unit{0};
    std::vector<int> bricks;  // numbers of those that may be in view, ascending

    const ZRange& of(const glm::vec3& ray) const {
        const glm::vec2 at = (glm::vec2(ray) - lowest) * cells_per_unit;
        return cells(glm::clamp(int(at.x), 0, cells.width - 1),
                     glm::clamp(int(at.y), 0, cells.height - 1));
    }
};

/// The ranges of a view up to `farthest` (m, along z); bricks nearer than `nearest` (m, > 0) count
/// as being there.
RayRanges ray_ranges(const VoxelVolume& volume, const CameraView& view,
                     const Pose& camera_from_world, float nearest, float farthest);

}  // namespace inlay
