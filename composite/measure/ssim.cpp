// Structural similarity (Wang et al. 2004).
#include "composite/measure/image_error.h"
#include "composite/measure/masked_mean.h"
#include "composite/measure/separable.h"

namespace inlay {
namespace {

constexpr double window_sigma = 1.5;  // px
constexpr int window_radius = 5;      // px
constexpr double c1 = (0.01 * 255) * (0.01 * 255);
constexpr double c2 = (0.03 * 255) * (0.03 * 255);

Image<double> encoded_luminance(const Image<EncodedRgb>& image) {
    Image<double> result(image.width, image.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const EncodedRgb& c = image.pixels[i];
        result.pixels[i] = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
    }
    return result;
}

Image<double> product(const Image<double>& a, const Image<double>& b) {
    Image<double> result(a.width, a.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        result.pixels[i] = a.pixels[i] * b.pixels[i];
    return result;
}

/// The kernel's weight inside the image at each position along an axis of `size` pixels.
std::vector<double> inside_weight(const Kernel& kernel, int size) {
    std::vector<double> weight(std::size_t(size), 0.0);
    const int r = int(kernel.size() / 2);
    for (int x = 0; x < size; ++x)
        for (int i = -r; i <= r; ++i)
            if (x + i >= 0 && x + i < size) weight[std::size_t(x)] += kernel[std::size_t(i + r)];
    return weight;
}

/// Weighted mean over the part of the window that lies in the image.
Image<double> window_mean(const Image<double>& image, const Kernel& kernel) {
    const int r = window_radius;
    Image<double> padded(image.width + 2 * r, image.height + 2 * r, 0.0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            padded(x + r, y + r) = image(x, y);
    const Image<double> sums = convolve(padded, kernel, kernel);
    const std::vector<double> across = inside_weight(kernel, image.width);
    const std::vector<double> down = inside_weight(kernel, image.height);
    Image<double> mean(image.width, image.height);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            mean(x, y) = sums(x + r, y + r) / (across[std::size_t(x)] * down[std::size_t(y)]);
    return mean;
}

}  // namespace

Image<float> ssim_map(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference) {
    check_comparable(image, reference);
    const Kernel kernel = normalised(gaussian_kernel(window_sigma, window_radius));
    const Image<double> a = encoded_luminance(image);
    const Image<double> b = encoded_luminance(reference);
    const Image<double> mean_a = window_mean(a, kernel);
    const Image<double> mean_b = window_mean(b, kernel);
    const Image<double> mean_aa = window_mean(product(a, a), kernel);
    const Image<double> mean_bb = window_mean(product(b, b), kernel);
    const Image<double> mean_ab = window_mean(product(a, b), kernel);
    Image<float> map(image.width, image.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const double ma = mean_a.pixels[i];
        const double mb = mean_b.pixels[i];
        const double variance_a = mean_aa.pixels[i] - ma * ma;
        const double variance_b = mean_bb.pixels[i] - mb * mb;
        const double covariance = mean_ab.pixels[i] - ma * mb;
        map.pixels[i] = float((2 * ma * mb + c1) * (2 * covariance + c2) /
                              ((ma * ma + mb * mb + c1) * (variance_a + variance_b + c2)));
    }
    return map;
}

}  // namespace inlay
