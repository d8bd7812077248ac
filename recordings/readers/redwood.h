// Redwood and Open3D: numbered images in a color and a depth folder, poses in a .log.
#pragma once

#include "recordings/readers/recording.h"

namespace inlay {

/// Whether the folder holds depth/ and one of color/, image/, rgb/.
bool recognises_redwood(const std::filesystem::path& folder);

/// Depth in mm. Images pair by number, or by time where all names carry a stamp (Redwood's object
/// scans). Poses come from trajectory.log in the folder or one level below, else from the only
/// .log there; its index counts the color images in numeric order. The lens is that of
/// camera_intrinsic.json (or camera.json; column-major 3x3), else 525, 525, 319.5, 239.5.
Recording open_redwood(const std::filesystem::path& folder, const OpenOptions& options);

}  // namespace inlay
