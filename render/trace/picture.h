// A whole picture by path tracing, with its standard error; and exact depth.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "render/trace/path_tracer.h"

namespace inlay {

/// From where, and with which random numbers, a picture is taken.
struct PictureView {
    Lens lens;
    Pose world_from_camera;
    std::uint32_t seed = 1, frame = 0;
};

struct Picture {
    Image<Rgb> radiance;                // mean over the pixel's area
    Image<Rgb> standard_error;          // of that mean, from the samples' spread
    std::uint64_t dropped_samples = 0;  // non-finite ones, left out
};

/// `samples` >= 2 paths per pixel, box-filtered over the pixel's area. The standard error treats
/// samples as independent; stratification makes the true one smaller.
Picture trace_picture(const EmbreeScene& scene, const EnvironmentSampler& environment,
                      const PictureView& view, int samples);

/// z-depth (m) through the centre of each pixel, 0 where nothing is hit.
Image<float> trace_depth(const EmbreeScene& scene, const Lens& lens, const Pose& world_from_camera);

}  // namespace inlay
