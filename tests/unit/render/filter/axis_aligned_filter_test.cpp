// The separable filter against the direct sum, box averages, and constants.
#include "render/filter/axis_aligned_filter.h"

#include "recordings/base/random.h"
#include "render/filter/filter_weight.h"
#include "render/filter/reference_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr float spacing = 0.01f;  // m

/// Noise on a plane of one object, with one width.
FilterPlanes plane(int width, int height, float precision, std::uint32_t seed) {
    const Image<float> blank(width, height, 0.0f);
    auto surface = std::make_shared<SurfacePlanes>();
    surface->position.fill(blank);
    surface->normal.fill(blank);
    FilterPlanes planes{surface,
                        Image<std::uint32_t>(width, height, 1),
                        Image<float>(width, height, precision),
                        Image<float>(width, height, precision),
                        {2, blank}};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const SampleKey key{seed, 0, std::uint32_t(blank.index(x, y)), 0};
            surface->position[0](x, y) = spacing * float(x);
            surface->position[1](x, y) = spacing * float(y);
            surface->normal[2](x, y) = 1;
            for (std::size_t c = 0; c < 2; ++c)
                planes.channels[c](x, y) = uniform(key, std::uint32_t(c));
        }
    }
    return planes;
}

float precision_of(double width_px) { return float(1 / std::pow(width_px * double(spacing), 2)); }

double largest_difference(const std::vector<Image<float>>& a, const std::vector<Image<float>>& b) {
    double largest = 0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        for (std::size_t i = 0; i < a[c].pixels.size(); ++i)
            largest = std::max(largest, std::abs(double(a[c].pixels[i]) - double(b[c].pixels[i])));
    }
    return largest;
}

TEST(FilterWeight, IsTheGaussianOfTheMeanPrecision) {
    const FilterPlanes p = plane(64, 1, precision_of(5), 1);
    std::vector<float> w(64);
    for (int i = 0; i < 40; ++i) {
        weigh(pixel_run(p, p.precision_x, 0, 0), pixel_run(p, p.precision_x, i, 0), 64 - i, 0.9f,
              w.data());
        const double truth = std::exp(-0.5 * i * i / 25.0);
        // exponents up to 32 in single precision: 32 x 6e-8 x a few roundings; nothing below e^-60
        EXPECT_NEAR(double(w[0]), truth, 1e-5 * truth + 1e-26) << i;
        EXPECT_EQ(i == 0 ? w[0] : 1.0f, 1.0f);
    }
}

TEST(AxisAlignedFilter, IsTheDirectSumOnAPlaneWithOneWidth) {
    for (const double width : {0.6, 2.0, 5.0, 100.0}) {
        const FilterPlanes p = plane(40, 30, precision_of(width), 2);
        // rounding: sums of 21 weights twice, values below 1
        EXPECT_LT(largest_difference(filter_axis_aligned(p, nullptr, {10}),
                                     filter_reference(p, nullptr, {10})),
                  2e-6);
    }
}

TEST(AxisAlignedFilter, SharesOneNormalisationWithThePreviousFrame) {
    const FilterPlanes now = plane(40, 30, precision_of(3), 3);
    const FilterPlanes before = plane(40, 30, precision_of(3), 4);
    EXPECT_LT(largest_difference(filter_axis_aligned(now, &before, {10}),
                                 filter_reference(now, &before, {10})),
              2e-6);  // rounding, as above
}

TEST(AxisAlignedFilter, IsCloseToTheDirectSumWhereWidthsVary) {
    FilterPlanes p = plane(60, 40, 0, 5);
    for (int y = 0; y < 40; ++y) {
        for (int x = 0; x < 60; ++x)
            p.precision_x(x, y) = p.precision_y(x, y) =
                precision_of(3 + 1.5 * std::sin(0.1 * x) * std::cos(0.1 * y));
    }
    // Widths change by half over 16 pixels, which the two steps see apart: some percent of the
    // noise's own deviation (0.29) remain, and less than the unfiltered difference by far.
    EXPECT_LT(largest_difference(filter_axis_aligned(p, nullptr, {15}),
                                 filter_reference(p, nullptr, {15})),
              0.02);
    EXPECT_GT(largest_difference(p.channels, filter_reference(p, nullptr, {15})), 0.3);
}

TEST(AxisAlignedFilter, IsABoxAverageWithoutABandwidth) {
    const FilterPlanes p = plane(20, 17, 0, 6);
    const int radius = 4;
    const auto smooth = filter_axis_aligned(p, nullptr, {radius});
    for (int y = 0; y < 17; ++y) {
        for (int x = 0; x < 20; ++x) {
            double sum = 0, count = 0;
            for (int v = std::max(y - radius, 0); v <= std::min(y + radius, 16); ++v) {
                for (int u = std::max(x - radius, 0); u <= std::min(x + radius, 19); ++u)
                    sum += double(p.channels[0](u, v)), ++count;
            }
            EXPECT_NEAR(smooth[0](x, y), sum / count, 1e-6);  // rounding of 81 terms below 1
        }
    }
}

TEST(AxisAlignedFilter, KeepsAConstantToTheBit) {
    FilterPlanes now = plane(33, 21, precision_of(2.3), 7);
    FilterPlanes before = plane(33, 21, precision_of(1.1), 8);
    for (FilterPlanes* p : {&now, &before}) {
        p->channels[0] = Image<float>(33, 21, 0.1f);
        p->channels[1] = Image<float>(33, 21, 3.14159274f);
        for (int i = 0; i < 33; ++i)
            p->precision_x(i, i / 2) = precision_of(0.4);
    }
    before.object(5, 5) = 0;
    before.channels[0](5, 5) = before.channels[1](5, 5) = 0;
    const auto smooth = filter_axis_aligned(now, &before, {15});
    for (std::size_t c = 0; c < 2; ++c)
        EXPECT_EQ(smooth[c].pixels, now.channels[c].pixels);
}

TEST(AxisAlignedFilter, TheThesisFractionLosesLightWhereTheCommonOneDoesNot) {
    // Eq. 6.26 with a constant 1 in both frames: the second sum is divided twice.
    const double w[] = {0.3, 1, 0.3}, w_before[] = {0.2, 0.6, 0.2};
    double sum = 0, sum_before = 0;
    for (int j = 0; j < 3; ++j)
        sum += w[j], sum_before += w_before[j];
    const double all = sum + sum_before;
    EXPECT_DOUBLE_EQ((sum + sum_before) / all, 1);
    EXPECT_LT((sum + sum_before / all) / all, 0.9);
}

TEST(AxisAlignedFilter, GivesChannelsOfTheSameBitsTheSameBits) {
    FilterPlanes now = plane(31, 19, precision_of(2), 9);
    FilterPlanes before = plane(31, 19, precision_of(3), 10);
    now.channels[1] = now.channels[0];
    before.channels[1] = before.channels[0];
    const auto smooth = filter_axis_aligned(now, &before, {7});
    EXPECT_EQ(smooth[0].pixels, smooth[1].pixels);
}

TEST(AxisAlignedFilter, NeverMixesObjectsOrNormals) {
    FilterPlanes p = plane(24, 24, 0, 11);
    auto surface = std::make_shared<SurfacePlanes>(*p.surface);
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 24; ++x) {
            p.object(x, y) = x < 8 ? 1 : 2;
            if (y >= 12) surface->normal[0](x, y) = 0.6f, surface->normal[2](x, y) = 0.8f;
            p.channels[0](x, y) = float((x < 8 ? 1 : 2) + (y >= 12 ? 4 : 0));
        }
    }
    p.surface = surface;
    EXPECT_EQ(filter_axis_aligned(p, nullptr, {15})[0].pixels, p.channels[0].pixels);
}

}  // namespace
}  // namespace inlay
