// Volume + pose -> the surface that a camera there would see.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

struct RaycastSettings {
    float nearest = 0.15f;         // m, along z
    float farthest = 6.0f;         // m, along z
    float least_weight = 0.0f;     // observations; surfaces with no more are not seen
    float full_confidence = 8.0f;  // observations at which confidence reaches 1
};

/// Throws Error that names the setting which is out of range.
void validate(const RaycastSettings& settings);

/// The zero crossing along each pixel's ray, by trilinear interpolation, from the free side only;
/// normals are the field's gradient. The lens's distortion is honoured.
/// Newcombe et al. 2011 (KinectFusion), Sec. 3.4.
SurfaceMap raycast_volume(const VoxelVolume& volume, const Lens& lens,
                          const Pose& world_from_camera, const RaycastSettings& settings);

}  // namespace inlay
