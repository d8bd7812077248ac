#include "composite/accuracy/sensor_bounds.h"

#include "recordings/synthetic/sensor_noise.h"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace inlay {
namespace {

/// A model knows a surface to half of its voxels, and a pose that is fitted to a model knows its
/// place no better: what poses may be off by (voxels).
constexpr double place_tolerance = 0.5;
/// An image knows an edge to half of its pixels: what a pose's turn may move the image by, and
/// what the places that depth is taken at move edges by (px).
constexpr double pixel_tolerance = 0.5;
/// Normals are differences of the model over this many voxels, one to each side.
constexpr double normal_span = 2;

/// Standard deviation (m) of depth as it is stored.
double depth_sigma(double z, bool sensor_noise) {
    const DepthNoiseSettings noise;
    if (sensor_noise) return double(axial_sigma(float(z), noise));
    return double(noise.depth_unit) / std::sqrt(12.0);  // rounding alone
}

double square(double x) { return x * x; }

}  // namespace

SensorBounds sensor_bounds(const Image<float>& depth, const Lens& lens, double voxel_size,
                           bool sensor_noise) {
    double axial = 0, place = 0, tilt = 0;
    std::size_t count = 0;
    for (const float measured : depth.pixels) {
        if (!(measured > 0)) continue;
        const double z = double(measured), sigma = depth_sigma(z, sensor_noise);
        axial += square(lens.fx * sigma / z);
        place += square(lens.fx * place_tolerance * voxel_size / z);
        // The difference of two depths, each with its own noise, over the span.
        tilt += square(std::atan(std::numbers::sqrt2 * sigma / (normal_span * voxel_size)));
        ++count;
    }
    if (count == 0) return {};
    const double n = double(count);
    const double lateral = sensor_noise ? double(DepthNoiseSettings{}.lateral_sigma) : 0.0;
    const double turned = square(pixel_tolerance);
    return {std::sqrt(axial / n + place / n + square(lateral) + turned),
            std::sqrt(place / n + turned), std::sqrt(tilt / n)};
}

}  // namespace inlay
