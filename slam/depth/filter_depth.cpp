#include "slam/depth/filter_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/lanes.h"
#include "recordings/base/parallel.h"
#include "slam/depth/framed_depth.h"
#include "slam/depth/steep_surface.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inlay {
namespace {

constexpr int least_neighbours = 3;  // of 8 that a trusted pixel needs on its own surface

bool measured(float z, const DepthSettings& s) {
    return std::isfinite(z) && z >= s.nearest && z <= s.farthest;
}

/// Writes the lanes that lie within a row.
void store(const Floats& values, Image<float>& image, int x, int y) {
    const auto numbers = numbers_of(values);
    std::copy(numbers.begin(), numbers.begin() + std::min(lane_count, image.width - x),
              image.pixels.begin() + std::ptrdiff_t(image.index(x, y)));
}

/// Of eight measured pixels, those with too few neighbours on their own surface.
Lanes stand_alone(const FramedDepth& depth, int x, int y, const DepthSettings& settings) {
    const Floats z = depth.eight(x, y);
    const Floats step = depth_step(z, settings);
    Floats neighbours = -1;  // the pixel itself is counted below
    for (int v = -1; v <= 1; ++v) {
        for (int u = -1; u <= 1; ++u)
            where(stdx::abs(depth.eight(x + u, y + v) - z) <= step, neighbours) += 1;
    }
    return z > 0 && neighbours < float(least_neighbours);
}

std::vector<float> spatial_weights(const DepthSettings& settings) {
    const int r = settings.smoothing_radius;
    std::vector<float> weights;
    for (int v = -r; v <= r; ++v) {
        for (int u = -r; u <= r; ++u) {
            const float d = float(u * u + v * v);
            weights.push_back(
                std::exp(-d / (2 * settings.smoothing_sigma * settings.smoothing_sigma)));
        }
    }
    return weights;
}

/// Eight smoothed depths; holes stay 0.
Floats smoothed(const FramedDepth& clean, int x, int y, const std::vector<float>& spatial,
                const DepthSettings& settings) {
    const Floats z = clean.eight(x, y);
    const Floats per_step = 1.0f / (depth_step(z, settings));
    const int r = settings.smoothing_radius;
    Floats sum = 0, weight = 0;
    const float* near = spatial.data();
    for (int v = -r; v <= r; ++v) {
        for (int u = -r; u <= r; ++u, ++near) {
            const Floats beyond = clean.eight(x + u, y + v) - z, steps = beyond * per_step;
            const Floats kept = stdx::max(1 - steps * steps, Floats(0));
            const Floats w = *near * (kept * kept);
            sum += w * beyond;
            weight += w;
        }
    }
    return choose(z > 0, z + sum / weight, 0);
}

}  // namespace

void validate(const DepthSettings& s) {
    require(s.nearest > 0 && s.nearest < s.farthest && std::isfinite(s.farthest),
            "slam.depth.nearest must be above 0 and below slam.depth.farthest", ExitCode::usage);
    require(s.step > 0 && s.sensor_noise > 0,
            "slam.depth.step and slam.depth.sensor_noise must be above 0", ExitCode::usage);
    require(s.steepest >= 0 && s.steepest <= 0.25f, "slam.depth.steepest must be 0..0.25",
            ExitCode::usage);
    require(s.smoothing_radius >= 0 && s.smoothing_radius <= 16 && s.smoothing_sigma > 0,
            "slam.depth.smoothing_radius must be 0..16 and slam.depth.smoothing_sigma above 0",
            ExitCode::usage);
}

Image<float> clean_depth(const Image<float>& depth, const DepthSettings& settings) {
    Image<float> in_range(depth.width, depth.height);
    std::transform(depth.pixels.begin(), depth.pixels.end(), in_range.pixels.begin(),
                   [&](float z) { return measured(z, settings) ? z : 0.0f; });
    const FramedDepth surroundings = framed(in_range, 1);
    Image<unsigned char> alone(depth.width, depth.height);
    parallel_rows(depth.height, [&](int y) {
        for (int x = 0; x < depth.width; x += lane_count) {
            const Lanes found = stand_alone(surroundings, x, y, settings);
            if (none_of(found)) continue;
            for (int lane = 0; lane < std::min(lane_count, depth.width - x); ++lane)
                alone(x + lane, y) = found[std::size_t(lane)];
        }
    });
    Image<float> clean = in_range;
    parallel_rows(depth.height, [&](int y) {
        for (int x = 0; x < depth.width; ++x) {
            if (alone(x, y) != 0 && !steep_plane(in_range, {x, y}, settings, &alone))
                clean(x, y) = 0;
        }
    });
    return clean;
}

Image<float> smooth_depth(const Image<float>& clean, const DepthSettings& settings) {
    if (settings.smoothing_radius == 0) return clean;
    const std::vector<float> spatial = spatial_weights(settings);
    const FramedDepth surroundings = framed(clean, settings.smoothing_radius);
    Image<float> result(clean.width, clean.height);
    parallel_rows(clean.height, [&](int y) {
        for (int x = 0; x < clean.width; x += lane_count)
            store(smoothed(surroundings, x, y, spatial, settings), result, x, y);
    });
    return result;
}

Image<float> filter_depth(const Image<float>& depth, const DepthSettings& settings) {
    return smooth_depth(clean_depth(depth, settings), settings);
}

}  // namespace inlay
