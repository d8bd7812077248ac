// References: what they leave out, which pixels count as influenced, and whose noise is subtracted.
#include "composite/accuracy/reference.h"

#include "composite/accuracy/error_estimate.h"
#include "composite/accuracy/report_pictures.h"
#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace inlay {
namespace {

constexpr int width = 64, height = 64;

Image<Rgb> flat(float value) { return Image<Rgb>(width, height, Rgb(value)); }

/// Uniform noise of standard deviation `sigma`, independent per pixel and channel.
Image<Rgb> with_noise(Image<Rgb> image, float sigma, std::uint32_t seed) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] +=
                sigma * std::sqrt(12.0f) *
                (uniform({seed, 0, std::uint32_t(i), 0}, std::uint32_t(c)) - 0.5f);
    return image;
}

TEST(Reference, ItsOwnNoiseIsTakenOut) {
    const Image<Rgb> photo = flat(0.2f);
    const Reference reference =
        mean_of_halves(with_noise(flat(0.5f), 0.02f, 1), with_noise(flat(0.5f), 0.02f, 2), photo);
    const Image<Rgb> judged = with_noise(flat(0.5f), 0.05f, 3);
    const FrameError error = error_against(reference, judged, encode(judged));
    // 12288 values: the mean square of uniform noise is known to about 1 %, of both together less.
    EXPECT_NEAR(std::sqrt(error.mean_square), 0.05, 0.001);
    EXPECT_NEAR(influenced_standard_error(reference), 0.02 / std::sqrt(2.0), 0.0004);
    EXPECT_TRUE(error.influenced);
}

TEST(Reference, OfThePictureItselfLeavesNothing) {
    const Reference reference = make_reference(flat(0.5f), flat(0.01f), flat(0.2f));
    const FrameError error = error_against(reference, flat(0.5f), encode(flat(0.5f)));
    EXPECT_EQ(error.mean_square, 0);  // never negative
    EXPECT_EQ(error.psnr, 100);
}

TEST(Reference, OnlyVisibleAndSignificantChangesAreInfluenced) {
    Image<Rgb> with = flat(0.5f), noise = flat(0.0f);
    with(0, 0) = Rgb(0.6f);
    with(1, 0) = Rgb(0.503f);  // less than a viewer sees
    with(2, 0) = Rgb(0.6f);
    noise(2, 0) = Rgb(0.02f);  // within six standard errors
    const Reference reference = make_reference(with, noise, flat(0.5f));
    EXPECT_EQ(reference.influenced(0, 0), 1);
    EXPECT_EQ(reference.influenced(1, 0), 0);
    EXPECT_EQ(reference.influenced(2, 0), 0);
}

TEST(Reference, PixelsThatAreNotFiniteAreLeftOutAndCounted) {
    Image<Rgb> with = flat(0.5f);
    with(3, 3).g = std::numeric_limits<float>::quiet_NaN();
    with(4, 3).r = std::numeric_limits<float>::infinity();
    const Reference reference = make_reference(with, flat(0), flat(0.2f));
    EXPECT_EQ(reference.left_out, 2u);
    const FrameError error = error_against(reference, flat(0.5f), encode(flat(0.5f)));
    EXPECT_EQ(error.mean_square, 0);
    const Reference nothing =
        make_reference(flat(std::numeric_limits<float>::quiet_NaN()), flat(0), flat(0.2f));
    EXPECT_THROW(error_against(nothing, flat(0.5f), encode(flat(0.5f))), Error);
}

TEST(Reference, WithoutInfluenceThereIsNoFigureOfIt) {
    const FrameError error = error_against(make_reference(flat(0.5f), flat(0), flat(0.5f)),
                                           flat(0.4f), encode(flat(0.4f)));
    EXPECT_FALSE(error.influenced);
    EXPECT_EQ(error.mean_square_influenced, 0);
    EXPECT_NEAR(error.mean_square, 0.01, 1e-6);
}

TEST(Reference, AnotherSizeIsRefused) {
    EXPECT_THROW(make_reference(flat(0.5f), flat(0), Image<Rgb>(3, 3)), Error);
}

TEST(ErrorEstimate, SeesBiasAndNoiseAndNotTheQuartersVariance) {
    const Mask all(width, height, 1);
    const Image<Rgb> a = with_noise(flat(0.5f), 0.2f, 1), b = with_noise(flat(0.5f), 0.2f, 2);
    // Standard error of the product's mean: 0.2^2 / sqrt(12288) = 3.6e-4, against 0.05^2 = 2.5e-3.
    EXPECT_NEAR(std::pow(estimate_error(flat(0.55f), a, b, all, 4).rmse, 2), 0.0025, 1.1e-3);
    const Image<Rgb> noisy = with_noise(flat(0.5f), 0.1f, 3);
    EXPECT_NEAR(std::pow(estimate_error(noisy, a, b, all, 4).rmse, 2), 0.01, 1.3e-3);
    EXPECT_LT(estimate_error(flat(0.5f), a, b, all, 4).rmse, std::sqrt(1.1e-3));
}

TEST(ErrorEstimate, ShowsWhereTheErrorIs) {
    Image<Rgb> filtered = flat(0.5f);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width / 2; ++x)
            filtered(x, y) = Rgb(0.7f);
    const ErrorEstimate estimate =
        estimate_error(filtered, with_noise(flat(0.5f), 0.1f, 1), with_noise(flat(0.5f), 0.1f, 2),
                       Mask(width, height, 1), 4);
    EXPECT_GT(estimate.mean_square(10, 30), 0.02f);
    EXPECT_LT(estimate.mean_square(50, 30), 0.01f);
}

TEST(DataUrl, IsBaseSixtyFour) {
    const auto url = [](const std::string& text) {
        return data_url(std::as_bytes(std::span(text)));
    };
    EXPECT_EQ(url(""), "data:image/png;base64,");
    EXPECT_EQ(url("M"), "data:image/png;base64,TQ==");
    EXPECT_EQ(url("Ma"), "data:image/png;base64,TWE=");
    EXPECT_EQ(url("Man"), "data:image/png;base64,TWFu");
    EXPECT_EQ(url("Many"), "data:image/png;base64,TWFueQ==");
}

}  // namespace
}  // namespace inlay
