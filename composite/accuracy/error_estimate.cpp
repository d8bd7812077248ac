#include "composite/accuracy/error_estimate.h"

#include "composite/blend/differential.h"
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace inlay {
namespace {

constexpr std::uint32_t estimate_seed_offset = 0xe571;
constexpr int window_radius = 4;  // px; the quarters' noise is averaged over 81 pixels

/// Mean over the window of each masked pixel, of the masked ones; 0 elsewhere.
Image<float> window_mean(const Image<float>& values, const Mask& mask, int radius) {
    Image<float> result(values.width, values.height, 0.0f);
    for (int y = 0; y < values.height; ++y) {
        for (int x = 0; x < values.width; ++x) {
            if (mask(x, y) == 0) continue;
            double sum = 0;
            int count = 0;
            for (int v = std::max(0, y - radius); v <= std::min(values.height - 1, y + radius); ++v)
                for (int u = std::max(0, x - radius); u <= std::min(values.width - 1, x + radius);
                     ++u) {
                    if (mask(u, v) == 0) continue;
                    sum += double(values(u, v));
                    ++count;
                }
            result(x, y) = float(sum / count);
        }
    }
    return result;
}

double mean_over(const Image<float>& values, const Mask& mask) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.pixels.size(); ++i) {
        if (mask.pixels[i] == 0) continue;
        sum += double(values.pixels[i]);
        ++count;
    }
    return count > 0 ? sum / double(count) : 0;
}

/// Ranks 0, 1, ...; equal values share their mean rank.
std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
    std::vector<double> ranks(values.size());
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i;
        while (end < order.size() && values[order[end]] == values[order[i]])
            ++end;
        for (std::size_t k = i; k < end; ++k)
            ranks[order[k]] = 0.5 * double(i + end - 1);
        i = end;
    }
    return ranks;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const double n = double(a.size());
    if (a.size() < 2) return 0;
    const double mean_a = std::accumulate(a.begin(), a.end(), 0.0) / n;
    const double mean_b = std::accumulate(b.begin(), b.end(), 0.0) / n;
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - mean_a) * (b[i] - mean_b);
        aa += (a[i] - mean_a) * (a[i] - mean_a);
        bb += (b[i] - mean_b) * (b[i] - mean_b);
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// The picture from a share 1 / `parts` of the samples, of a seed of its own.
Image<Rgb> partial_picture(const Work& work, const TrackedFrame& frame, const Settings& settings,
                           int parts, std::uint32_t which) {
    const int samples = settings.trace.primary * settings.trace.secondary;
    SamplingSettings sampling = share_of_samples(settings.trace, std::max(1, samples / parts));
    sampling.seed += estimate_seed_offset + which;
    // a raw ratio has its right mean only if both modes share their noise
    if (parts != 2) sampling.estimator = Estimator::two_mode;
    const SampledFrame sampled = sample_frame(work, frame, sampling, std::uint32_t(frame.frame));
    FilterSettings filter = settings.filter;
    filter.enabled = parts == 2;  // the first half is filtered, the quarters are raw
    return composite(
               *frame.photo,
               filter_layers(sampled.result.layers, nullptr, work.environment_bandwidth, filter),
               settings.blend)
        .linear;
}

Image<float> squared_error(const Image<Rgb>& image, const Image<Rgb>& reference) {
    Image<float> result(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const Rgb d = image.pixels[i] - reference.pixels[i];
        result.pixels[i] = glm::dot(d, d) / 3;
    }
    return result;
}

}  // namespace

ErrorEstimate estimate_error(const Image<Rgb>& filtered, const Image<Rgb>& a, const Image<Rgb>& b,
                             const Mask& mask, int radius) {
    require(same_size(filtered, a) && same_size(filtered, b) && same_size(filtered, mask),
            "error estimate: pictures and mask must have one size");
    Image<float> product(filtered.width, filtered.height);
    for (std::size_t i = 0; i < filtered.pixels.size(); ++i) {
        const Rgb& f = filtered.pixels[i];
        product.pixels[i] = glm::dot(f - a.pixels[i], f - b.pixels[i]) / 3;
    }
    ErrorEstimate estimate;
    estimate.rmse = std::sqrt(std::max(0.0, mean_over(product, mask)));
    estimate.mean_square = window_mean(product, mask, radius);
    return estimate;
}

SamplingSettings share_of_samples(SamplingSettings sampling, int samples) {
    require(samples > 0, "a share of samples must hold one", ExitCode::usage);
    sampling.primary = std::min(sampling.primary, samples);
    while (samples % sampling.primary != 0)
        --sampling.primary;
    sampling.secondary = samples / sampling.primary;
    return sampling;
}

std::optional<EstimateQuality> check_estimate(const Work& work,
                                              const std::vector<JudgedFrame>& frames,
                                              const Settings& settings) {
    if (settings.trace.primary * settings.trace.secondary < 2) return std::nullopt;
    EstimateQuality quality;
    std::vector<double> estimated, truth;
    double estimated_sum = 0, true_sum = 0;
    for (const JudgedFrame& frame : frames) {
        if (!frame.converged) continue;
        const Mask& mask = frame.converged->influenced;
        if (std::find(mask.pixels.begin(), mask.pixels.end(), 1) == mask.pixels.end()) continue;
        const Image<Rgb> filtered = partial_picture(work, frame.now, settings, 2, 0);
        const ErrorEstimate estimate =
            estimate_error(filtered, partial_picture(work, frame.now, settings, 4, 1),
                           partial_picture(work, frame.now, settings, 4, 2), mask, window_radius);
        const Image<float> squares = squared_error(filtered, frame.converged->linear);
        const Image<float> smooth = window_mean(squares, mask, window_radius);
        const double noise = influenced_standard_error(*frame.converged);
        const double true_square = std::max(0.0, mean_over(squares, mask) - noise * noise);
        for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
            if (mask.pixels[i] == 0) continue;
            estimated.push_back(double(estimate.mean_square.pixels[i]));
            truth.push_back(double(smooth.pixels[i]));
        }
        estimated_sum += estimate.rmse * estimate.rmse;
        true_sum += true_square;
        quality.frames.push_back({frame.now.frame, estimate.rmse, std::sqrt(true_square)});
    }
    if (quality.frames.empty()) return std::nullopt;
    quality.rank_correlation = correlation(ranks_of(estimated), ranks_of(truth));
    quality.calibration = true_sum > 0 ? estimated_sum / true_sum : 0;
    return quality;
}

}  // namespace inlay
