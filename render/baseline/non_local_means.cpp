#include "render/baseline/non_local_means.h"

#include "recordings/base/check.h"
#include "render/baseline/guides.h"
#include "render/baseline/smooth_receivers.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace inlay {
namespace {

/// Median over the pixels with an object; 0 without any.
float median_of(const Image<float>& values, const Image<std::uint32_t>& object) {
    std::vector<float> kept;
    for (std::size_t i = 0; i < values.pixels.size(); ++i)
        if (object.pixels[i] != 0) kept.push_back(values.pixels[i]);
    if (kept.empty()) return 0;
    const auto middle = kept.begin() + std::ptrdiff_t(kept.size() / 2);
    std::nth_element(kept.begin(), middle, kept.end());
    return *middle;
}

/// Patches are compared where both have pixels of their own objects.
struct Patches {
    const Image<std::uint32_t>& object;
    Image<float> luminance;
    int radius;
    float noise, scale;  // 2 s^2, 1 / (h s)^2

    void add_exponents(const PairRun& run, float* __restrict exponents) const;
    void add_row(const PairRun& run, int dy, std::vector<float>& squares,
                 std::vector<float>& counts) const;
};

/// Adds row `dy` of the patches to the sums per column; column i is the image's run.x - radius + i.
void Patches::add_row(const PairRun& run, int dy, std::vector<float>& squares,
                      std::vector<float>& counts) const {
    const int y = run.y + dy, y_other = y + run.tap.dy;
    if (y < 0 || y >= object.height || y_other < 0 || y_other >= object.height) return;
    const int begin = std::max({run.x - radius, 0, -run.tap.dx});
    const int end = std::min({run.x + run.count + radius, object.width, object.width - run.tap.dx});
    const float *own = &luminance(begin, y), *other = &luminance(begin + run.tap.dx, y_other);
    const std::uint32_t *a = &object(begin, y), *b = &object(begin + run.tap.dx, y_other);
    float* __restrict square = squares.data() + (begin - run.x + radius);
    float* __restrict count = counts.data() + (begin - run.x + radius);
    for (int k = 0; k < end - begin; ++k) {
        const float both = a[k] != 0 && a[k] == b[k] ? 1.0f : 0.0f;
        const float d = other[k] - own[k];
        square[k] += both * d * d;
        count[k] += both;
    }
}

void Patches::add_exponents(const PairRun& run, float* __restrict exponents) const {
    const auto columns = std::size_t(run.count + 2 * radius);
    thread_local std::vector<float> squares, counts;
    squares.assign(columns, 0.0f);
    counts.assign(columns, 0.0f);
    for (int dy = -radius; dy <= radius; ++dy)
        add_row(run, dy, squares, counts);
    for (int k = 0; k < run.count; ++k) {
        float square = 0, count = 0;
        for (int i = 0; i <= 2 * radius; ++i) {
            square += squares[std::size_t(k + i)];
            count += counts[std::size_t(k + i)];
        }
        const float distance = square / std::max(count, 1.0f);
        exponents[k] += std::max(distance - noise, 0.0f) * scale;
    }
}

void smooth(FilterPlanes& planes, double strength, const NonLocalMeansSettings& settings) {
    Image<float> luminance = guide_luminance(planes);
    const Image<float> variance =
        local_variance(planes.object, luminance, [](const PairRun&, float*) {});
    const double noise = median_of(variance, planes.object);
    const double scale = 1 / std::max(strength * strength * noise, 1e-30);
    const Patches patches{planes.object, std::move(luminance), settings.patch_radius,
                          float(2 * noise), float(scale)};
    const std::vector<Tap> taps =
        gaussian_taps(settings.search_radius, std::numeric_limits<double>::infinity());
    planes.channels =
        weighted_means(planes.object, planes.channels, nullptr, taps,
                       [&](const PairRun& run, float* to) { patches.add_exponents(run, to); })
            .channels;
}

}  // namespace

Layers non_local_means(const NoisyLayers& now, double strength,
                       const NonLocalMeansSettings& settings) {
    require_width(strength, "non-local means: strength");
    require(settings.search_radius >= 1 && settings.search_radius <= 50 &&
                settings.patch_radius >= 0 && settings.patch_radius <= 10,
            "non-local means: the radii are " + std::to_string(settings.search_radius) + " and " +
                std::to_string(settings.patch_radius) +
                " px, expected 1 to 50 for the search and 0 to 10 for the patch",
            ExitCode::usage);
    return smooth_receivers(now, SmootherNeeds{.lights_apart = true, .surface = false},
                            [&](FilterPlanes& planes) { smooth(planes, strength, settings); });
}

}  // namespace inlay
