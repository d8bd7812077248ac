// How much noise the filter leaves, against the closed form of a weighted mean.
#include "render/filter/filter_layers.h"
#include "tests/support/filter_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

using namespace test;

constexpr double spacing = 0.02;  // m
constexpr int size = 240, radius = 15;

/// Mean and variance of E_R's direct light, three values per pixel, away from the border.
struct Moments {
    double mean = 0, variance = 0;
};

Moments moments_of(const Image<Rgb>& image) {
    double sum = 0, square = 0, count = 0;
    for (int y = radius; y < size - radius; ++y) {
        for (int x = radius; x < size - radius; ++x) {
            for (int c = 0; c < 3; ++c) {
                const double v = double(image(x, y)[c]);
                sum += v, square += v * v, ++count;
            }
        }
    }
    return {sum / count, square / count - sum / count * (sum / count)};
}

/// The sum of squared weights of a row over the square of their sum.
double variance_factor(double width_px) {
    double sum = 0, square = 0;
    for (int i = -radius; i <= radius; ++i) {
        const double w = std::exp(-0.5 * i * i / (width_px * width_px));
        sum += w, square += w * w;
    }
    return square / (sum * sum);
}

TEST(FilterNoise, HasTheVarianceOfItsWeightsAndKeepsTheMean) {
    NoisyLayers layers = noisy_plane(size, size, spacing, 1);
    for (const double width : {1.5, 3.0}) {
        for (float& c : layers.real.occluder_direct.pixels)
            c = float(1 / (width * spacing * (2.36 + 10)));
        const Layers smooth = filter_layers(layers, nullptr, 10, {});
        const Moments left = moments_of(smooth.direct.e_r);
        const double factor = variance_factor(width);
        // Independent kernels: about (size / (3.5 sigma))^2 per channel. Mean: variance 1/12 of the
        // border-free noise itself; variance: relative error sqrt(2 / kernels). Both at 4 sigma.
        const double kernels = 3 * std::pow((size - 2 * radius) / (3.5 * width), 2);
        EXPECT_NEAR(left.mean, 0.5, 4 * std::sqrt(factor * factor / 12 / kernels));
        EXPECT_NEAR(left.variance / (factor * factor / 12), 1, 4 * std::sqrt(2 / kernels));
    }
}

}  // namespace
}  // namespace inlay
