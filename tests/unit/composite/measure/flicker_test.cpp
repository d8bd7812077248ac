// Flicker against closed forms.
#include "composite/measure/flicker.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace inlay {
namespace {

const Image<Rgb> no_truth;

/// Uniform noise about `mean` with variance s^2, on its own in every frame, pixel and channel.
Image<Rgb> noise(int width, int height, std::uint32_t frame, double mean, double s) {
    Image<Rgb> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const SampleKey key{.seed = 7, .frame = frame, .pixel = std::uint32_t(i)};
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] =
                float(mean + s * std::sqrt(12.0) * (double(uniform(key, std::uint32_t(c))) - 0.5));
    }
    return image;
}

/// A picture that no symmetry hides.
Image<Rgb> slope(int width, int height, double shift) {
    Image<Rgb> image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            image(x, y) = {float(x + shift), float(2 * y + x * shift), float(1 + shift * shift)};
    return image;
}

Flicker flicker_between(const ShownFrame& before, const ShownFrame& now, const Mask& mask = {}) {
    FlickerSums sums;
    add_flicker(sums, before, now, mask);
    return flicker_of(sums);
}

TEST(Flicker, OfAConstantSequenceIsZero) {
    const Image<Rgb> picture = slope(5, 4, 0.5);
    const Flicker flicker = flicker_between({picture, no_truth}, {picture, no_truth});
    EXPECT_EQ(flicker.rms, 0);
    EXPECT_EQ(flicker.pixels, 20u);
    EXPECT_EQ(flicker.non_finite, 0u);
}

TEST(Flicker, OfAMovingPictureThatEqualsItsTruthIsZero) {
    const Image<Rgb> first = slope(5, 4, 0), second = slope(5, 4, 0.75);
    EXPECT_EQ(flicker_between({first, first}, {second, second}).rms, 0);
}

TEST(Flicker, OfAnErrorThatStaysIsZeroAndOfOneThatGrowsItsGrowth) {
    const Image<Rgb> truth_first = slope(6, 3, 0), truth_second = slope(6, 3, 1);
    Image<Rgb> first = truth_first, second = truth_second;
    for (Rgb& p : first.pixels)
        p += Rgb(0.5f);
    for (Rgb& p : second.pixels)
        p += Rgb(0.5f);
    EXPECT_EQ(flicker_between({first, truth_first}, {second, truth_second}).rms, 0);
    for (Rgb& p : second.pixels)
        p += Rgb(0.25f);
    EXPECT_EQ(flicker_between({first, truth_first}, {second, truth_second}).rms, 0.25);
}

TEST(Flicker, OfWhiteNoiseIsItsDeviationTimesTheRootOfTwo) {
    constexpr int frames = 9;
    constexpr double s = 0.2, mean = 3;
    FlickerSums still, moving;
    std::vector<Image<Rgb>> pictures, truths, moved;
    for (std::uint32_t t = 0; t < frames; ++t) {
        pictures.push_back(noise(64, 48, t, mean, s));
        truths.push_back(slope(64, 48, 0.1 * t));
        moved.push_back(truths.back());
        for (std::size_t i = 0; i < moved.back().pixels.size(); ++i)
            moved.back().pixels[i] += pictures.back().pixels[i];
    }
    for (std::size_t t = 1; t < frames; ++t) {
        add_flicker(still, {pictures[t - 1], no_truth}, {pictures[t], no_truth});
        add_flicker(moving, {moved[t - 1], truths[t - 1]}, {moved[t], truths[t]});
    }
    // 73728 squared differences, each the sum of two uniform variables of variance s^2, neighbors
    // in time correlated: the relative deviation of their mean's root is below 0.5 %.
    const double expected = s * std::numbers::sqrt2;
    EXPECT_NEAR(flicker_of(still).rms, expected, 0.02 * expected);
    // Sums up to 130 in single precision are off by up to 8e-6.
    EXPECT_NEAR(flicker_of(moving).rms, flicker_of(still).rms, 2e-5);
    EXPECT_EQ(flicker_of(still).pixels, 8u * 64 * 48);
}

TEST(Flicker, LeavesOutAndCountsWhatIsNotFiniteInAnyOfTheFour) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinite = std::numeric_limits<float>::infinity();
    Image<Rgb> first(6, 1, Rgb(1)), second(6, 1, Rgb(3)), truth_first(6, 1, Rgb(0));
    Image<Rgb> truth_second = truth_first;
    first(0, 0).r = nan;
    second(1, 0).g = infinite;
    truth_first(2, 0).b = nan;
    truth_second(3, 0).r = -infinite;
    const Flicker flicker = flicker_between({first, truth_first}, {second, truth_second});
    EXPECT_EQ(flicker.non_finite, 4u);
    EXPECT_EQ(flicker.pixels, 2u);
    EXPECT_EQ(flicker.rms, 2.0);
}

TEST(Flicker, CountsOnlyWhatTheMaskCounts) {
    Image<Rgb> first(4, 1, Rgb(0)), second(4, 1, Rgb(9));
    second(1, 0) = second(3, 0) = Rgb(0.5f);
    Mask counted(4, 1, 0);
    counted(1, 0) = counted(3, 0) = 1;
    const Flicker flicker = flicker_between({first, no_truth}, {second, no_truth}, counted);
    EXPECT_EQ(flicker.rms, 0.5);
    EXPECT_EQ(flicker.pixels, 2u);
}

TEST(Flicker, RefusesWhatCannotBeCompared) {
    const Image<Rgb> picture(4, 4, Rgb(1)), other(4, 5, Rgb(1));
    EXPECT_THROW(flicker_between({picture, no_truth}, {other, no_truth}), Error);
    EXPECT_THROW(flicker_between({picture, picture}, {picture, no_truth}), Error);
    EXPECT_THROW(flicker_between({picture, other}, {picture, other}), Error);
    EXPECT_THROW(flicker_between({picture, no_truth}, {picture, no_truth}, Mask(4, 4, 0)), Error);
    EXPECT_THROW(flicker_between({picture, no_truth}, {picture, no_truth}, Mask(3, 4, 1)), Error);
    EXPECT_THROW(flicker_of({}), Error);
}

}  // namespace
}  // namespace inlay
