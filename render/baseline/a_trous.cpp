#include "render/baseline/a_trous.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/baseline/smooth_receivers.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <utility>

namespace inlay {
namespace {

/// Offsets at multiples of `step` (px) with the outer products of `half`, weights relative to the
/// centre's.
std::vector<Tap> product_taps(std::span<const double> half, int step) {
    std::vector<Tap> taps;
    const int radius = int(half.size()) - 1;
    for (int v = -radius; v <= radius; ++v) {
        for (int u = -radius; u <= radius; ++u) {
            const double weight = half[std::size_t(std::abs(u))] * half[std::size_t(std::abs(v))];
            if (u != 0 || v != 0) taps.push_back({u * step, v * step, float(-std::log(weight))});
        }
    }
    return taps;
}

/// 1 / (sigma_l sqrt(variance)) with the variance blurred over 3 x 3 pixels.
Image<float> luminance_precision(const Image<std::uint32_t>& object, const Image<float>& variance,
                                 double sigma) {
    constexpr std::array<double, 2> half{1.0, 0.5};
    const Means blurred = weighted_means(object, {variance}, nullptr, product_taps(half, 1),
                                         [](const PairRun&, float*) {});
    Image<float> result = blurred.channels[0];
    for (float& v : result.pixels)
        v = float(1 / (sigma * std::sqrt(std::max(double(v), 0.0)) + 1e-10));
    return result;
}

void smooth_level(FilterPlanes& planes, const AddExponents& surface, int step, double sigma,
                  Image<float>& variance) {
    constexpr std::array<double, 3> b3_spline{1.0, 2.0 / 3, 1.0 / 6};  // (6, 4, 1) / 6
    const Image<float> luminance = guide_luminance(planes);
    const Image<float> precision = luminance_precision(planes.object, variance, sigma);
    const AddExponents exponents = [&](const PairRun& run, float* __restrict to) {
        surface(run, to);
        const float* own = &luminance(run.x, run.y);
        const float* other = &luminance(run.x + run.tap.dx, run.y + run.tap.dy);
        const float* scale = &precision(run.x, run.y);
        for (int k = 0; k < run.count; ++k)
            to[k] += std::abs(other[k] - own[k]) * scale[k];
    };
    Means means = weighted_means(planes.object, planes.channels, &variance,
                                 product_taps(b3_spline, step), exponents);
    planes.channels = std::move(means.channels);
    variance = std::move(means.variance);
}

}  // namespace

Layers a_trous(const NoisyLayers& now, int levels, const ATrousSettings& settings) {
    require(levels >= 1 && levels <= 5,
            "a-trous: levels is " + std::to_string(levels) + ", expected 1 to 5", ExitCode::usage);
    validate(settings.surface);
    require_width(settings.luminance_sigma, "a-trous: luminance_sigma");
    return smooth_receivers(now, SmootherNeeds{.lights_apart = true}, [&](FilterPlanes& planes) {
        const AddExponents surface =
            surface_exponents(planes, now.world_from_camera.translation, settings.surface);
        Image<float> variance = local_variance(planes.object, guide_luminance(planes), surface);
        for (int level = 0; level < levels; ++level)
            smooth_level(planes, surface, 1 << level, settings.luminance_sigma, variance);
    });
}

}  // namespace inlay
