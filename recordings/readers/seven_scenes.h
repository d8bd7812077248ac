// 7-Scenes and 3DMatch: frame-000000.{color,depth,pose} triples in one folder.
#pragma once

#include "recordings/readers/recording.h"

namespace inlay {

/// Whether the folder holds frame-NNNNNN.color.* files.
bool recognises_seven_scenes(const std::filesystem::path& folder);

/// Whether, besides, camera-intrinsics.txt lies in the folder or one level up.
bool recognises_three_d_match(const std::filesystem::path& folder);

/// Depth in mm; poses are camera-to-world, 4x4, and may be absent; no times. The lens is that of
/// camera-intrinsics.txt (3x3), else the Kinect's. gravity-direction.txt, where present, is a
/// vector in the world of the poses that points DOWN: it is opposite to the normals of floor and
/// table in 3DMatch's 7-scenes-redkitchen, to 2 degrees.
Recording open_seven_scenes(const std::filesystem::path& folder, const OpenOptions& options);

}  // namespace inlay
