// Depth -> positions and normals in the camera frame.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/depth/filter_depth.h"

namespace inlay {

/// The surface that a depth image (m, 0 = not measured) shows. Positions are exact; normals come
/// from differences over two pixels that stay on one surface, else from the plane of a surface seen
/// at a grazing angle (steep_plane()), and where there is none the pixel is a hole. Confidence
/// is 1. `depth` must have the lens's size (Error).
SurfaceMap surface_from_depth(const Image<float>& depth, const Lens& lens,
                              const Pose& world_from_camera, const DepthSettings& settings = {});

}  // namespace inlay
