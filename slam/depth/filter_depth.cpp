#include "slam/depth/filter_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
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

bool stands_alone(const Image<float>& depth, int x, int y, const DepthSettings& settings) {
    const float z = depth(x, y);
    const float step = depth_step(z, settings);
    int neighbours = -1;  // the pixel itself is counted below
    for (int v = std::max(0, y - 1); v <= std::min(depth.height - 1, y + 1); ++v) {
        for (int u = std::max(0, x - 1); u <= std::min(depth.width - 1, x + 1); ++u) {
            neighbours += std::abs(depth(u, v) - z) <= step;
        }
    }
    return neighbours < least_neighbours;
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

float smoothed(const Image<float>& clean, int x, int y, const std::vector<float>& spatial,
               const DepthSettings& settings) {
    const float z = clean(x, y);
    const int r = settings.smoothing_radius;
    const int left = std::max(-r, -x), right = std::min(r, clean.width - 1 - x);
    const float per_step = 1.0f / depth_step(z, settings);
    float sum = 0, weight = 0;
    for (int v = std::max(-r, -y); v <= std::min(r, clean.height - 1 - y); ++v) {
        const float* row = &clean.pixels[clean.index(x, y + v)];
        const int middle = (v + r) * (2 * r + 1) + r;
        const float* near = &spatial[std::size_t(middle)];
        for (int u = left; u <= right; ++u) {
            const float difference = (row[u] - z) * per_step;
            const float kept = std::max(0.0f, 1 - difference * difference);
            const float w = near[u] * kept * kept;
            sum += w * (row[u] - z);
            weight += w;
        }
    }
    return z + sum / weight;
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
    Image<unsigned char> alone(depth.width, depth.height);
    parallel_rows(depth.height, [&](int y) {
        for (int x = 0; x < depth.width; ++x)
            alone(x, y) = in_range(x, y) > 0 && stands_alone(in_range, x, y, settings);
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
    Image<float> result(clean.width, clean.height);
    parallel_rows(clean.height, [&](int y) {
        for (int x = 0; x < clean.width; ++x) {
            if (clean(x, y) > 0) result(x, y) = smoothed(clean, x, y, spatial, settings);
        }
    });
    return result;
}

Image<float> filter_depth(const Image<float>& depth, const DepthSettings& settings) {
    return smooth_depth(clean_depth(depth, settings), settings);
}

}  // namespace inlay
