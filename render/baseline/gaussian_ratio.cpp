#include "render/baseline/gaussian_ratio.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/baseline/masked_blur.h"
#include "render/baseline/smooth_receivers.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace inlay {
namespace {

using Channels = std::vector<Image<float>>;

// Channels of a real receiver: direct E_R, direct E_RV, indirect E_R, indirect E_RV, three each.
constexpr std::size_t real_channels = 12;

double mean_e_r(const FilterPlanes& planes) {
    const auto row_sum = [&](int y, auto&& term) {
        double sum = 0;
        for (int x = 0; x < planes.object.width; ++x)
            sum += planes.object(x, y) != 0 ? term(x) : 0.0;
        return sum;
    };
    const double count = ordered_sum(planes.object.height,
                                     [&](int y) { return row_sum(y, [](int) { return 1.0; }); });
    const double sum = ordered_sum(planes.object.height, [&](int y) {
        return row_sum(y, [&](int x) {
            double total = 0;
            for (std::size_t c = 0; c < 3; ++c)
                total += (double(planes.channels[c](x, y)) + planes.channels[c + 6](x, y)) / 3;
            return total;
        });
    });
    return count > 0 ? sum / count : 0.0;
}

float bounded_ratio(double e_r, double e_rv, double epsilon, double max_ratio) {
    if (e_r == e_rv) return 1;
    const double ratio = (e_rv + epsilon) / (e_r + epsilon);
    return std::isfinite(ratio) ? float(std::clamp(ratio, 0.0, max_ratio)) : 1.0f;
}

Channels ratios_of(const FilterPlanes& planes, const RatioBounds& bounds) {
    const double epsilon = bounds.epsilon_share * mean_e_r(planes);
    const Image<float> blank(planes.object.width, planes.object.height, 0.0f);
    Channels ratios(3, blank);
    parallel_rows(blank.height, [&](int y) {
        for (std::size_t c = 0; c < 3; ++c) {
            for (int x = 0; x < blank.width; ++x) {
                const Channels& e = planes.channels;
                const double e_r = double(e[c](x, y)) + e[c + 6](x, y);
                const double e_rv = double(e[c + 3](x, y)) + e[c + 9](x, y);
                ratios[c](x, y) = bounded_ratio(e_r, e_rv, epsilon, bounds.max_ratio);
            }
        }
    });
    return ratios;
}

void blur_ratio(FilterPlanes& planes, double sigma, const RatioBounds& bounds) {
    Channels ratios = ratios_of(planes, bounds);
    blur_masked(planes.object, sigma, ratios);
    for (std::size_t c = 0; c < real_channels; ++c)
        std::fill(planes.channels[c].pixels.begin(), planes.channels[c].pixels.end(),
                  c < 3 ? 1.0f : 0.0f);
    for (std::size_t c = 0; c < 3; ++c)
        planes.channels[c + 3] = std::move(ratios[c]);
}

}  // namespace

Layers gaussian_ratio(const NoisyLayers& now, double sigma, const RatioBounds& bounds) {
    require_width(sigma, "the Gaussian's sigma");
    require_width(bounds.epsilon_share, "the ratio's epsilon_share");
    require(bounds.max_ratio >= 1 && std::isfinite(bounds.max_ratio),
            "the ratio's max_ratio is " + std::to_string(bounds.max_ratio) +
                ", expected 1 or more, finite",
            ExitCode::usage);
    return smooth_receivers(now, SmootherNeeds{.surface = false}, [&](FilterPlanes& planes) {
        if (planes.channels.size() == real_channels)
            blur_ratio(planes, sigma, bounds);
        else
            blur_masked(planes.object, sigma, planes.channels);
    });
}

}  // namespace inlay
