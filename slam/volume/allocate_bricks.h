// Makes room in the volume around the surface that a frame sees.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

/// Allocates every brick that the line of sight of a pixel crosses within the truncation of its
/// surface; of pixels that lie closer than a voxel, one line stands for its neighbors. Bricks are
/// numbered by the rows and columns of the pixels that first need them, for any number of threads.
void allocate_bricks(VoxelVolume& volume, const SurfaceMap& surface);

}  // namespace inlay
