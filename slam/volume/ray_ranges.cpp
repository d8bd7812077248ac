#include "slam/volume/ray_ranges.h"

#include "slam/volume/bricks_in_view.h"

#include <algorithm>

namespace inlay {
namespace {

constexpr int pixels_per_cell = 8;
constexpr int reach = 1;           // voxels beyond a brick that trilinear distances need
constexpr int gradient_reach = 2;  // that gradients need

struct Box {
    glm::vec2 lowest{1e30f}, highest{-1e30f};
    ZRange z;
};

/// Bounds of a brick, grown by what a distance reads around a point, as (x/z, y/z) and z. A brick
/// across the near plane bounds nothing: it may appear anywhere.
Box bounds(const glm::ivec3& key, float voxel_size, const Pose& camera_from_world, float nearest) {
    const glm::mat3 rotation(camera_from_world.rotation);
    const glm::vec3 translation(camera_from_world.translation);
    Box box;
    for (int c = 0; c < 8; ++c) {
        const glm::ivec3 corner(c & 1, (c >> 1) & 1, c >> 2);
        const glm::vec3 voxel(key * brick_side - reach + corner * (brick_side - 1 + 2 * reach));
        const glm::vec3 p = rotation * (voxel * voxel_size) + translation;
        box.z.nearest = std::min(box.z.nearest, std::max(p.z, nearest));
        box.z.farthest = std::max(box.z.farthest, p.z);
        if (p.z < nearest) {
            box.lowest = glm::vec2(-1e30f);
            box.highest = glm::vec2(1e30f);
            continue;
        }
        box.lowest = glm::min(box.lowest, glm::vec2(p) / p.z);
        box.highest = glm::max(box.highest, glm::vec2(p) / p.z);
    }
    return box;
}

/// The slices that [nearest, farthest] touches.
std::uint64_t slices_between(float nearest, float farthest) {
    const std::uint64_t all = ~std::uint64_t(0);
    return (all << ZRange::slice_of(nearest)) &
           (all >> (ZRange::slices - 1 - ZRange::slice_of(farthest)));
}

void mark(RayRanges& ranges, const Box& box) {
    const glm::vec2 size(ranges.cells.width, ranges.cells.height);
    const auto cell = [&](const glm::vec2& at) {
        return glm::clamp((at - ranges.lowest) * ranges.cells_per_unit, glm::vec2(-1), size);
    };
    const std::uint64_t occupied = slices_between(box.z.nearest, box.z.farthest);
    const glm::ivec2 from(glm::floor(cell(box.lowest))), to(glm::floor(cell(box.highest)));
    for (int y = std::max(from.y, 0); y <= std::min(to.y, ranges.cells.height - 1); ++y) {
        for (int x = std::max(from.x, 0); x <= std::min(to.x, ranges.cells.width - 1); ++x) {
            ZRange& range = ranges.cells(x, y);
            range.nearest = std::min(range.nearest, box.z.nearest);
            range.farthest = std::max(range.farthest, box.z.farthest);
            range.occupied |= occupied;
        }
    }
}

}  // namespace

RayRanges ray_ranges(const VoxelVolume& volume, const CameraView& view,
                     const Pose& camera_from_world, float nearest, float farthest) {
    RayRanges ranges;
    ranges.cells = Image<ZRange>(view.lens.width / pixels_per_cell + 1,
                                 view.lens.height / pixels_per_cell + 1);
    ranges.lowest = view.lowest;
    ranges.cells_per_unit =
        glm::vec2(ranges.cells.width, ranges.cells.height) / (view.highest - view.lowest);
    ranges.bricks = bricks_in_view(volume, view, camera_from_world, gradient_reach, farthest);
    for (const int number : ranges.bricks) {
        const Box box =
            bounds(volume.keys[std::size_t(number)], volume.voxel_size, camera_from_world, nearest);
        if (box.z.farthest > nearest) mark(ranges, box);
    }
    return ranges;
}

}  // namespace inlay
