// The surface that a frame is composited on: the model as its lens sees it.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "recordings/base/surface_map.h"
#include "slam/mapping/slam_settings.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

/// The model as the frame's lens (distortion included) sees it from its pose, completed by the
/// frame's own depth, as one observation, where the model has no surface. Of a frame that is lost,
/// the model from where it was seen last, with confidence 0.
SurfaceMap see_model(const VoxelVolume& volume, const RgbdFrame& frame, const TrackResult& tracking,
                     const SlamSettings& settings);

/// Takes all confidence from a surface.
void forget(SurfaceMap& surface);

/// `model`, completed by `own` of the same lens and pose.
SurfaceMap completed(SurfaceMap model, const SurfaceMap& own, const RaycastSettings& settings);

}  // namespace inlay
