// Which bricks of a volume a camera may see.
#pragma once

#include "recordings/base/pose.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/voxel_volume.h"

#include <vector>

namespace inlay {

/// Numbers of the bricks, grown by `margin` voxels on each side, that the view may see up to
/// `farthest` (m, along z); ascending.
std::vector<int> bricks_in_view(const VoxelVolume& volume, const CameraView& view,
                                const Pose& camera_from_world, int margin, float farthest);

}  // namespace inlay
