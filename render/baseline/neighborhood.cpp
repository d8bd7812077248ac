// One row at a time; per tap, weights of the whole row first, then what they add to each channel.
#include "render/baseline/neighborhood.h"

#include "recordings/base/parallel.h"
#include "render/filter/filter_weight.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

struct RowSums {
    std::vector<float> exponents, weights;    // of the pairs at hand
    std::vector<float> total, variance;       // sum of w; of w^2 variance
    std::vector<std::vector<float>> channel;  // sum of w times difference

    RowSums(std::size_t width, std::size_t channels)
        : exponents(width),
          weights(width),
          total(width, 1.0f),
          variance(width, 0.0f),
          channel(channels, std::vector<float>(width, 0.0f)) {}
};

void weigh(const Image<std::uint32_t>& object, const PairRun& run, RowSums& sums) {
    const std::uint32_t* own = &object(run.x, run.y);
    const std::uint32_t* other = &object(run.x + run.tap.dx, run.y + run.tap.dy);
    const float* exponents = sums.exponents.data();
    float* __restrict weights = sums.weights.data();
    for (int k = 0; k < run.count; ++k) {
        const std::int32_t alike = std::int32_t(own[k] == other[k]) & std::int32_t(own[k] != 0);
        weights[k] = exp_minus(exponents[k], alike);
    }
}

void add_differences(float* __restrict sum, const float* weights, const float* other,
                     const float* own, int count) {
    for (int k = 0; k < count; ++k)
        sum[k] += weights[k] * (other[k] - own[k]);
}

void add_run(const PairRun& run, const std::vector<Image<float>>& channels,
             const Image<float>* variance, RowSums& sums) {
    const float* weights = sums.weights.data();
    float* __restrict total = sums.total.data() + run.x;
    for (int k = 0; k < run.count; ++k)
        total[k] += weights[k];
    for (std::size_t c = 0; c < channels.size(); ++c)
        add_differences(sums.channel[c].data() + run.x, weights,
                        &channels[c](run.x + run.tap.dx, run.y + run.tap.dy),
                        &channels[c](run.x, run.y), run.count);
    if (variance == nullptr) return;
    float* __restrict spread = sums.variance.data() + run.x;
    const float* other = &(*variance)(run.x + run.tap.dx, run.y + run.tap.dy);
    for (int k = 0; k < run.count; ++k)
        spread[k] += weights[k] * weights[k] * other[k];
}

}  // namespace

Means weighted_means(const Image<std::uint32_t>& object, const std::vector<Image<float>>& channels,
                     const Image<float>* variance, std::span<const Tap> taps,
                     const AddExponents& add_exponents) {
    const int width = object.width, height = object.height;
    Means means{std::vector<Image<float>>(channels.size(), Image<float>(width, height, 0.0f)),
                Image<float>(width, height, 0.0f)};
    parallel_rows(height, [&](int y) {
        RowSums sums(std::size_t(width), channels.size());
        for (const Tap& tap : taps) {
            const int x = std::max(0, -tap.dx), count = std::min(width, width - tap.dx) - x;
            if (y + tap.dy < 0 || y + tap.dy >= height || count <= 0) continue;
            const PairRun run{x, y, count, tap};
            std::fill_n(sums.exponents.data(), count, tap.exponent);
            add_exponents(run, sums.exponents.data());
            weigh(object, run, sums);
            add_run(run, channels, variance, sums);
        }
        for (int x = 0; x < width; ++x) {
            if (object(x, y) == 0) continue;
            const float total = sums.total[std::size_t(x)];
            for (std::size_t c = 0; c < channels.size(); ++c)
                means.channels[c](x, y) =
                    channels[c](x, y) + sums.channel[c][std::size_t(x)] / total;
            if (variance != nullptr)
                means.variance(x, y) =
                    ((*variance)(x, y) + sums.variance[std::size_t(x)]) / (total * total);
        }
    });
    return means;
}

std::vector<Tap> gaussian_taps(int radius, double sigma) {
    std::vector<Tap> taps;
    for (int dy = -radius; dy <= radius; ++dy) {
        for (int dx = -radius; dx <= radius; ++dx) {
            if (dx == 0 && dy == 0) continue;
            taps.push_back({dx, dy, float(0.5 * (dx * dx + dy * dy) / (sigma * sigma))});
        }
    }
    return taps;
}

}  // namespace inlay
