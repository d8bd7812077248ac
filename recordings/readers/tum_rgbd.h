// TUM RGB-D: the text lists rgb.txt, depth.txt and groundtruth.txt beside two image folders.
#pragma once

#include "recordings/readers/recording.h"

namespace inlay {

/// Whether the folder holds rgb.txt and depth.txt.
bool recognises_tum(const std::filesystem::path& folder);

/// Depth in 1/5000 m. Color and depth are paired by time within 0.02 s, each used once; a frame's
/// number is its place among the pairs, and its time and pose are those of the color image, the
/// pose interpolated in groundtruth.txt (optional; camera-to-world). The lens is known for
/// freiburg1 to 3, by the folder's name or by the name the lists carry, else the 525 px default
/// with a warning; their world has z up (in freiburg1_rpy the desk's normal is +z, to 5 degrees).
/// A camera.json {"width", "height", "lens": [fx, fy, cx, cy], "distortion": [k1,
/// k2, p1, p2, k3], "depth_scale": units per m, "up": [x, y, z]} overrides what it mentions.
Recording open_tum(const std::filesystem::path& folder, const OpenOptions& options);

}  // namespace inlay
