// The camera that took a frame's photograph.
#pragma once

#include "slam/mapping/reconstruct_recording.h"

namespace inlay {

struct ColorCamera {
    Lens lens;
    Pose color_from_depth;  // with the camera's motion between the two images
};

/// Whether the color camera is not the depth camera.
inline bool color_is_apart(const Reconstruction& reconstruction) {
    const auto& found = reconstruction.registration;
    return found && (found->needed || found->delay_needed);
}

/// Of the frame at a position in `reconstruction.frames`: the depth camera itself, with `lens`,
/// where registration is not needed.
ColorCamera color_camera_of(const Reconstruction& reconstruction, int position, const Lens& lens);

/// Estimates the registration from frames that are tracked. No estimate (0 points) for recordings
/// of fewer than 12 such frames or less than 320 px across.
ColorRegistration register_recording(const Reconstruction& reconstruction,
                                     const FrameSource& source, const SlamSettings& settings);

}  // namespace inlay
