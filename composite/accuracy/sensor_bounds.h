// SensorBounds: how far sensor and poses may move what is seen, whatever the program makes of them.
#pragma once

#include "composite/accuracy/work.h"

namespace inlay {

/// Of one frame, root mean squares over the pixels that show a real surface.
struct SensorBounds {
    double displaced_px = 0;  // of the tracked surface in the image: noise and poses
    double model_px = 0;      // of the surface that exact depth and poses leave: the model's grain
    double tilt = 0;          // rad, of the surface's normals
};

/// From the true z-depth (m, 0 = nothing), the noise model that the recording was made with
/// (Nguyen, Izadi and Lovell 2012), the stated tolerance of poses and the model's voxels (m). No
/// result of tracking or fusion enters.
SensorBounds sensor_bounds(const Image<float>& depth, const Lens& lens, double voxel_size,
                           bool sensor_noise);

}  // namespace inlay
