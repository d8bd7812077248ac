#include "composite/measure/separable.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace inlay {
namespace {

int radius_of(const Kernel& kernel) { return int(kernel.size() / 2); }

}  // namespace

Kernel gaussian_kernel(double sigma, int radius) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x)
        kernel.push_back(std::exp(-0.5 * (x / sigma) * (x / sigma)));
    return kernel;
}

Kernel normalised(Kernel kernel) {
    const double sum = std::accumulate(kernel.begin(), kernel.end(), 0.0);
    for (double& weight : kernel)
        weight /= sum;
    return kernel;
}

Image<double> convolve(const Image<double>& image, const Kernel& across, const Kernel& down) {
    const int width = image.width;
    const int height = image.height;
    Image<double> rows(width, height);
    parallel_rows(height, [&](int y) {
        const int r = radius_of(across);
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            for (int i = -r; i <= r; ++i)
                sum += across[std::size_t(i + r)] * image(std::clamp(x + i, 0, width - 1), y);
            rows(x, y) = sum;
        }
    });
    Image<double> result(width, height, 0.0);
    parallel_rows(height, [&](int y) {
        const int r = radius_of(down);
        for (int i = -r; i <= r; ++i) {
            const double weight = down[std::size_t(i + r)];
            const auto source = rows.row(std::clamp(y + i, 0, height - 1));
            for (int x = 0; x < width; ++x)
                result(x, y) += weight * source[std::size_t(x)];
        }
    });
    return result;
}

}  // namespace inlay
