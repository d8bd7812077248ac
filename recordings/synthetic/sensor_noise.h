// Depth as a structured-light sensor of the Kinect class would have measured it.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/random.h"

namespace inlay {

/// sigma(z) = axial_floor + axial_growth (z - axial_nearest)^2 and the lateral sigma are those that
/// Nguyen, Izadi and Lovell 2012 (3DIMPVT) measured; the stereo figures are the sensor's.
struct DepthNoiseSettings {
    float axial_floor = 0.0012f;     // m
    float axial_growth = 0.0019f;    // 1/m
    float axial_nearest = 0.4f;      // m
    float lateral_sigma = 0.8f;      // px, of the place that is measured in place of a pixel's own
    float baseline = 0.075f;         // m, projector to camera
    float disparity_step = 0.125f;   // px; 0: no quantisation of disparity
    float edge_step = 0.05f;         // relative difference to a neighbour that makes a depth edge
    float edge_dropout = 0.6f;       // probability that a pixel at a depth edge is not measured
    float grazing_start = 1.22f;     // rad (70 deg) from the normal, where drop-outs begin
    float grazing_end = 1.48f;       // rad (85 deg), beyond which nothing is measured
    float nearest = 0.4f;            // m, range of the sensor
    float farthest = 8.0f;           // m
    float depth_unit = 1.0f / 5000;  // m, of the stored integers; 0: no rounding
};

/// Throws Error (usage) when a setting is out of its range.
void validate(const DepthNoiseSettings& settings);

/// Standard deviation (m) of a measured z-depth (m), as above. It contains the quantisation of the
/// real sensor; simulate_sensor adds correspondingly less Gaussian noise.
float axial_sigma(float z, const DepthNoiseSettings& settings = {});

/// What the sensor measures of the exact z-depth `depth` (m, 0 = no surface): a neighbouring place
/// (lateral noise), axial noise, disparity in steps, and 0 = not measured at depth edges, at
/// grazing angles and out of range. Numbers depend on `key`'s seed and frame and on the pixel.
/// Throws Error: bad_data when the sizes of image and lens differ, usage for bad settings.
Image<float> simulate_sensor(const Image<float>& depth, const Lens& lens, const SampleKey& key,
                             const DepthNoiseSettings& settings = {});

}  // namespace inlay
