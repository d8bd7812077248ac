// Adds one depth image, with its colors, to the volume.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "recordings/base/surface_map.h"
#include "slam/volume/voxel_volume.h"

namespace inlay {

struct FusionSettings {
    float voxel_size = 0.008f;   // m
    float truncation = 0.032f;   // m, half-width of the signed-distance band
    float max_weight = 128.0f;   // observations; beyond it the mean slides
    float full_weight_z = 1.0f;  // m; a measurement beyond it counts (this / z)^2
    float least_cosine = 0.15f;  // surfaces seen at a more grazing angle are not fused
    int memory = 4096;           // MB that bricks may take; then the model takes in no new places
};

/// Throws Error that names the setting which is out of range.
void validate(const FusionSettings& settings);

/// An empty volume.
VoxelVolume make_volume(const FusionSettings& settings);

/// The photograph that belongs to a depth image.
struct SeenColor {
    const Image<EncodedRgb>& image;  // may be empty
    Lens lens;                       // of the image
    Pose color_from_depth;           // from the depth camera's frame to the color camera's
    Rgb gain{1};                     // linear photograph / what the model's exposure would record
};

/// Folds the surface that a frame saw, at its pose, into every voxel within the truncation of the
/// surface or in front of it: a weighted running mean of the distance to the surface's tangent
/// plane. Curless and Levoy 1996, eq. 3 and 4; differs: the weight is capped, and it falls with
/// distance and obliqueness as a structured-light camera's accuracy does. Same bytes for any number
/// of threads.
void fuse_surface(VoxelVolume& volume, const SurfaceMap& surface, const SeenColor& color,
                  const FusionSettings& settings);

/// The same for a filtered depth image (m, 0 = not measured) with a color image that is empty or
/// registered to it.
void fuse_depth(VoxelVolume& volume, const Image<float>& depth, const Image<EncodedRgb>& color,
                const Lens& lens, const Pose& world_from_camera, const FusionSettings& settings);

}  // namespace inlay
