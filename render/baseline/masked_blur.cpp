// Row pass and column pass, whose inner loops run along a row.
#include "render/baseline/masked_blur.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace inlay {
namespace {

/// weights[i] of pixels i px apart.
std::vector<double> half_kernel(double sigma, int longest) {
    std::vector<double> weights;
    const double radius = std::min(std::ceil(3 * sigma), double(longest));
    for (int i = 0; i <= int(radius); ++i)
        weights.push_back(std::exp(-0.5 * i * i / (sigma * sigma)));
    return weights;
}

/// sum += weight * values, in double precision.
void add_scaled(std::vector<double>& sum, const double* weights, const float* values) {
    double* __restrict to = sum.data();
    for (std::size_t k = 0; k < sum.size(); ++k)
        to[k] += weights[k] * double(values[k]);
}

/// The values of a row between as many zeros as the kernel reaches on either side.
struct PaddedRow {
    std::vector<double> values;
    int radius;

    PaddedRow(int width, int r) : values(std::size_t(width + 2 * r), 0.0), radius(r) {}
    double* begin() { return values.data() + radius; }
};

void convolve(PaddedRow& row, const std::vector<double>& kernel, std::vector<double>& sum) {
    const double* from = row.begin();
    double* __restrict to = sum.data();
    for (std::size_t k = 0; k < sum.size(); ++k)
        to[k] = kernel[0] * from[k];
    for (std::size_t i = 1; i < kernel.size(); ++i) {
        const double *left = from - i, *right = from + i;
        for (std::size_t k = 0; k < sum.size(); ++k)
            to[k] += kernel[i] * (left[k] + right[k]);
    }
}

/// Replaces a row of each channel by its mean along the row; returns the sums of weights.
void blur_row(std::span<const std::uint32_t> object, int y, const std::vector<double>& kernel,
              std::vector<Image<float>>& channels, std::span<float> mass) {
    PaddedRow row(int(object.size()), int(kernel.size()) - 1);
    std::vector<double> weights(object.size()), sum(object.size());
    for (std::size_t x = 0; x < object.size(); ++x)
        row.begin()[x] = object[x] != 0 ? 1.0 : 0.0;
    convolve(row, kernel, weights);
    std::copy(weights.begin(), weights.end(), mass.begin());
    for (Image<float>& channel : channels) {
        const std::span<float> values = channel.row(y);
        for (std::size_t x = 0; x < object.size(); ++x)
            row.begin()[x] = object[x] != 0 ? double(values[x]) : 0.0;
        convolve(row, kernel, sum);
        for (std::size_t x = 0; x < object.size(); ++x)
            values[x] = weights[x] > 0 ? float(sum[x] / weights[x]) : 0.0f;
    }
}

}  // namespace

void blur_masked(const Image<std::uint32_t>& object, double sigma,
                 std::vector<Image<float>>& channels) {
    if (object.empty()) return;
    const int height = object.height;
    const auto width = std::size_t(object.width);
    const std::vector<double> kernel = half_kernel(sigma, std::max(object.width, height));
    const int radius = int(kernel.size()) - 1;
    Image<float> mass(object.width, height, 0.0f);
    parallel_rows(height,
                  [&](int y) { blur_row(object.row(y), y, kernel, channels, mass.row(y)); });
    const std::vector<Image<float>> rows = channels;
    parallel_rows(height, [&](int y) {
        std::vector<double> weights(width), total(width, 0.0);
        std::vector<std::vector<double>> sums(channels.size(), std::vector<double>(width, 0.0));
        for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v) {
            for (std::size_t x = 0; x < width; ++x) {
                weights[x] = kernel[std::size_t(std::abs(v - y))] * double(mass.row(v)[x]);
                total[x] += weights[x];
            }
            for (std::size_t c = 0; c < sums.size(); ++c)
                add_scaled(sums[c], weights.data(), rows[c].row(v).data());
        }
        for (std::size_t c = 0; c < sums.size(); ++c) {
            for (std::size_t x = 0; x < width; ++x)
                channels[c].row(y)[x] = object.row(y)[x] != 0 ? float(sums[c][x] / total[x]) : 0.0f;
        }
    });
}

}  // namespace inlay
