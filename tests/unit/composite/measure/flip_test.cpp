// FLIP against closed forms for flat pictures and against its definition written out slowly.
#include "composite/measure/image_error.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr double pi = std::numbers::pi;

Image<EncodedRgb> flat(int width, int height, EncodedRgb color) {
    return Image<EncodedRgb>(width, height, color);
}

Image<EncodedRgb> noise(int width, int height, std::uint32_t seed) {
    Image<EncodedRgb> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const SampleKey key{.seed = seed, .pixel = std::uint32_t(i)};
        image.pixels[i] = {std::uint8_t(uniform(key, 0) * 256), std::uint8_t(uniform(key, 1) * 256),
                           std::uint8_t(uniform(key, 2) * 256)};
    }
    return image;
}

TEST(Flip, OfEqualPicturesIsZero) {
    EXPECT_EQ(flip(noise(30, 20, 1), noise(30, 20, 1)), 0.0);
    EXPECT_EQ(flip(flat(1, 1, {9, 9, 9}), flat(1, 1, {9, 9, 9})), 0.0);
}

TEST(Flip, OfBlackAndWhiteIsNearlyOne) {
    // Lightness differs by 100 and nothing else: 100^0.7 = 25.12, the largest color distance is
    // 203.3^0.7 = 41.3, and what lies above its 40 % is mapped to 0.95 .. 1: 0.967
    EXPECT_NEAR(flip(flat(20, 20, {0, 0, 0}), flat(20, 20, {255, 255, 255})), 0.967, 1e-3);
}

TEST(Flip, OfGreenAndBlueIsOne) {
    // the pair that the scale ends with; 1e-6: stored as float
    EXPECT_NEAR(flip(flat(20, 20, {0, 255, 0}), flat(20, 20, {0, 0, 255})), 1.0, 1e-6);
}

TEST(Flip, IsTheSameBothWays) {
    EXPECT_NEAR(flip(noise(24, 24, 1), noise(24, 24, 2)), flip(noise(24, 24, 2), noise(24, 24, 1)),
                1e-7);  // float
}

TEST(Flip, SeesLessOfFineNoiseFromFurtherAway) {
    const Image<EncodedRgb> grey = flat(64, 64, {128, 128, 128});
    const Image<EncodedRgb> noisy = noise(64, 64, 5);
    EXPECT_LT(flip(noisy, grey, {}, {.pixels_per_degree = 120}),
              flip(noisy, grey, {}, {.pixels_per_degree = 30}));
}

TEST(Flip, TakesTheMeanUnderTheMask) {
    Image<EncodedRgb> image = flat(90, 10, {100, 100, 100});
    for (int y = 0; y < 10; ++y)
        image(80, y) = {255, 0, 0};
    Mask left(90, 10, 0);
    for (int y = 0; y < 10; ++y)
        for (int x = 0; x < 40; ++x)
            left(x, y) = 1;
    const Image<EncodedRgb> reference = flat(90, 10, {100, 100, 100});
    EXPECT_EQ(flip(image, reference, left), 0.0);
    EXPECT_GT(flip(image, reference), 0.0);
}

// What follows is the paper's pipeline with two-dimensional kernels and no shortcut.

glm::dvec3 slow_xyz(const glm::dvec3& c) {  // relative to white
    return {(0.4123908 * c.r + 0.3575843 * c.g + 0.1804808 * c.b) / 0.9504559,
            0.2126390 * c.r + 0.7151687 * c.g + 0.0721923 * c.b,
            (0.0193308 * c.r + 0.1191948 * c.g + 0.9505322 * c.b) / 1.0890578};
}

glm::dvec3 slow_rgb(const glm::dvec3& relative) {
    const glm::dvec3 c = relative * glm::dvec3(0.9504559, 1.0, 1.0890578);
    return {3.2409699 * c.x - 1.5373832 * c.y - 0.4986108 * c.z,
            -0.9692436 * c.x + 1.8759675 * c.y + 0.0415551 * c.z,
            0.0556301 * c.x - 0.2039770 * c.y + 1.0569715 * c.z};
}

glm::dvec3 opponent(EncodedRgb c) {
    const glm::dvec3 n = slow_xyz(glm::dvec3(decode(c)));
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

/// Sum over a square window of weight(dx, dy) times the plane, the border repeated.
template <class Weight>
double window_sum(const Image<glm::dvec3>& image, glm::ivec2 at, int channel, int radius,
                  Weight weight) {
    double sum = 0;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const int x = std::clamp(at.x + dx, 0, image.width - 1);
            const int y = std::clamp(at.y + dy, 0, image.height - 1);
            sum += weight(dx, dy) * image(x, y)[channel];
        }
    return sum;
}

double sensitivity(int channel, double squared_degrees) {
    const auto term = [&](double a, double b) {
        return a * std::sqrt(pi / b) * std::exp(-pi * pi * squared_degrees / b);
    };
    if (channel == 0) return term(1, 0.0047);
    if (channel == 1) return term(1, 0.0053);
    return term(34.1, 0.04) + term(13.5, 0.025);
}

glm::dvec3 slow_seen(const Image<glm::dvec3>& image, glm::ivec2 at, double ppd) {
    const int radius = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const Image<glm::dvec3> ones(1, 1, glm::dvec3(1));
    glm::dvec3 c{0};
    for (int k = 0; k < 3; ++k) {
        const auto weight = [&](int dx, int dy) {
            return sensitivity(k, (dx * dx + dy * dy) / (ppd * ppd));
        };
        c[k] =
            window_sum(image, at, k, radius, weight) / window_sum(ones, {0, 0}, k, radius, weight);
    }
    const double y = (c.x + 16) / 116;
    const glm::dvec3 rgb = slow_rgb({y + c.y / 500, y, y - c.z / 200});
    const glm::dvec3 n = slow_xyz(glm::clamp(rgb, glm::dvec3(0), glm::dvec3(1)));
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116; };
    const double l = 116 * f(n.y) - 16;
    return {l, 0.01 * l * 500 * (f(n.x) - f(n.y)), 0.01 * l * 200 * (f(n.y) - f(n.z))};
}

double slow_feature(const Image<glm::dvec3>& image, glm::ivec2 at, double ppd, bool edge) {
    const double sigma = 0.5 * 0.082 * ppd;
    const int radius = int(std::ceil(3 * sigma));
    const auto raw = [&](int along, int dx, int dy) {
        const double g = std::exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
        return edge ? -along * g : (along * along / (sigma * sigma) - 1) * g;
    };
    glm::dvec2 gradient{0};
    for (int axis = 0; axis < 2; ++axis) {
        double positive = 0, negative = 0;
        for (int dy = -radius; dy <= radius; ++dy)
            for (int dx = -radius; dx <= radius; ++dx) {
                const double w = raw(axis == 0 ? dx : dy, dx, dy);
                (w > 0 ? positive : negative) += std::abs(w);
            }
        gradient[axis] = window_sum(image, at, 0, radius, [&](int dx, int dy) {
            const double w = raw(axis == 0 ? dx : dy, dx, dy);
            return w / (w > 0 ? positive : negative) / 116;
        });
    }
    return glm::length(gradient);
}

double slow_flip(const Image<EncodedRgb>& a, const Image<EncodedRgb>& b, glm::ivec2 at,
                 double ppd) {
    Image<glm::dvec3> oa(a.width, a.height), ob(a.width, a.height);
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        oa.pixels[i] = opponent(a.pixels[i]);
        ob.pixels[i] = opponent(b.pixels[i]);
    }
    const auto distance = [](const glm::dvec3& p, const glm::dvec3& q) {
        return std::pow(std::abs(p.x - q.x) + std::hypot(p.y - q.y, p.z - q.z), 0.7);
    };
    const Image<glm::dvec3> green(1, 1, opponent({0, 255, 0}));
    const Image<glm::dvec3> blue(1, 1, opponent({0, 0, 255}));
    const double largest = distance(slow_seen(green, {0, 0}, ppd), slow_seen(blue, {0, 0}, ppd));
    const double d = distance(slow_seen(oa, at, ppd), slow_seen(ob, at, ppd));
    const double color = d < 0.4 * largest ? 0.95 / (0.4 * largest) * d
                                           : 0.95 + 0.05 * (d - 0.4 * largest) / (0.6 * largest);
    const double edge = std::abs(slow_feature(oa, at, ppd, true) - slow_feature(ob, at, ppd, true));
    const double point =
        std::abs(slow_feature(oa, at, ppd, false) - slow_feature(ob, at, ppd, false));
    return std::pow(color, 1 - std::sqrt(std::max(edge, point) / std::sqrt(2.0)));
}

TEST(Flip, AgreesWithItsDefinitionWrittenOut) {
    const Image<EncodedRgb> a = noise(23, 19, 7);
    Image<EncodedRgb> b = noise(23, 19, 8);
    for (std::size_t i = 0; i < b.pixels.size(); i += 3)
        b.pixels[i] = a.pixels[i];
    for (const double ppd : {30.0, 67.0}) {
        const Image<float> map = flip_map(a, b, {.pixels_per_degree = ppd});
        for (const glm::ivec2 at : {glm::ivec2(0, 0), {11, 9}, {22, 18}, {3, 15}, {20, 2}})
            // 1e-5: seven-digit matrices and the rounded constants of CIELAB
            EXPECT_NEAR(map(at.x, at.y), slow_flip(a, b, at, ppd), 1e-5) << at.x << " " << at.y;
    }
}

}  // namespace
}  // namespace inlay
