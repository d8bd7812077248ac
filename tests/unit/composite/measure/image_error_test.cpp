// Image errors against closed forms.
#include "composite/measure/image_error.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace inlay {
namespace {

Image<EncodedRgb> grey(int width, int height, std::uint8_t value) {
    return Image<EncodedRgb>(width, height, {value, value, value});
}

Image<EncodedRgb> noise(int width, int height, std::uint32_t seed, int low = 0, int high = 255) {
    Image<EncodedRgb> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const SampleKey key{.seed = seed, .pixel = std::uint32_t(i)};
        const auto value = std::uint8_t(low + int(uniform(key, 0) * float(high - low)));
        image.pixels[i] = {value, value, value};
    }
    return image;
}

TEST(RadianceError, OfAConstantOffsetIsTheOffset) {
    const Image<Rgb> reference(8, 5, Rgb(2.0f));
    const Image<Rgb> image(8, 5, Rgb(2.25f));
    const RadianceError error = radiance_error(image, reference);
    EXPECT_EQ(error.rmse, 0.25);
    EXPECT_EQ(error.relative_rmse, 0.125);
    EXPECT_EQ(error.pixels, 40u);
}

TEST(RadianceError, OfEqualImagesIsZeroEvenInTheDark) {
    const Image<Rgb> black(4, 4, Rgb(0));
    EXPECT_EQ(radiance_error(black, black).rmse, 0);
    EXPECT_EQ(radiance_error(black, black).relative_rmse, 0);
    EXPECT_EQ(radiance_error(Image<Rgb>(4, 4, Rgb(1)), black).relative_rmse,
              std::numeric_limits<double>::infinity());
}

TEST(RadianceError, CountsEveryChannelAlike) {
    const Image<Rgb> reference(1, 1, Rgb(0));
    EXPECT_NEAR(radiance_error(Image<Rgb>(1, 1, {3, 0, 0}), reference).rmse, std::sqrt(3.0),
                1e-15);  // rounding
}

TEST(RadianceError, LeavesOutAndCountsWhatIsNotFinite) {
    Image<Rgb> image(4, 1, Rgb(1));
    Image<Rgb> reference(4, 1, Rgb(0));
    image(0, 0).g = std::numeric_limits<float>::quiet_NaN();
    reference(1, 0).b = std::numeric_limits<float>::infinity();
    const RadianceError error = radiance_error(image, reference);
    EXPECT_EQ(error.non_finite, 2u);
    EXPECT_EQ(error.pixels, 2u);
    EXPECT_EQ(error.rmse, 1.0);
}

TEST(RadianceError, LooksThroughTheMask) {
    Image<Rgb> image(4, 1, Rgb(0));
    image(2, 0) = Rgb(8);
    const Image<Rgb> reference(4, 1, Rgb(0));
    Mask mask(4, 1, 0);
    mask(2, 0) = mask(3, 0) = 1;
    EXPECT_EQ(radiance_error(image, reference, mask).rmse, std::sqrt(32.0));
    EXPECT_THROW(radiance_error(image, reference, Mask(4, 1, 0)), Error);
    EXPECT_THROW(radiance_error(image, reference, Mask(3, 1, 1)), Error);
}

TEST(Psnr, OfAKnownOffset) {
    // a difference of 16 in 255: 20 log10(255 / 16)
    EXPECT_NEAR(psnr(grey(9, 9, 100), grey(9, 9, 116)), 24.0485, 1e-4);  // digits given
    EXPECT_EQ(psnr(grey(9, 9, 0), grey(9, 9, 255)), 0.0);
    EXPECT_EQ(psnr(grey(9, 9, 7), grey(9, 9, 7)), std::numeric_limits<double>::infinity());
}

TEST(Ssim, OfEqualPicturesIsOne) {
    EXPECT_NEAR(ssim(noise(40, 30, 1), noise(40, 30, 1)), 1.0, 1e-6);  // stored as float
    EXPECT_NEAR(ssim(grey(3, 2, 0), grey(3, 2, 0)), 1.0, 1e-6);        // smaller than a window
}

TEST(Ssim, OfFlatPicturesIsTheLuminanceTerm) {
    const double a = 100, b = 150, c1 = 6.5025;
    const double expected = (2 * a * b + c1) / (a * a + b * b + c1);
    EXPECT_NEAR(ssim(grey(20, 20, 100), grey(20, 20, 150)), expected, 1e-6);  // float
}

TEST(Ssim, IsTheSameBothWaysAndFallsWithNoise) {
    const Image<EncodedRgb> clean = noise(48, 48, 1, 100, 160);
    const Image<EncodedRgb> other = noise(48, 48, 2, 100, 160);
    EXPECT_NEAR(ssim(clean, other), ssim(other, clean), 1e-7);
    EXPECT_LT(ssim(clean, other), 0.2);  // independent noise: no structure in common
}

/// Wang's formula with the window written out, for one pixel that is far from the border.
double slow_ssim(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference, int cx,
                 int cy) {
    double total = 0, a = 0, b = 0, aa = 0, bb = 0, ab = 0;
    for (int y = -5; y <= 5; ++y)
        for (int x = -5; x <= 5; ++x) {
            const double w = std::exp(-(x * x + y * y) / (2 * 1.5 * 1.5));
            const double va = image(cx + x, cy + y).r;
            const double vb = reference(cx + x, cy + y).r;
            total += w;
            a += w * va;
            b += w * vb;
            aa += w * va * va;
            bb += w * vb * vb;
            ab += w * va * vb;
        }
    a /= total;
    b /= total;
    const double c1 = 6.5025, c2 = 58.5225;
    const double variances = aa / total - a * a + bb / total - b * b;
    return (2 * a * b + c1) * (2 * (ab / total - a * b) + c2) /
           ((a * a + b * b + c1) * (variances + c2));
}

TEST(Ssim, AgreesWithTheFormulaWrittenOut) {
    const Image<EncodedRgb> image = noise(32, 24, 3, 60, 200);
    Image<EncodedRgb> reference = noise(32, 24, 4, 60, 200);
    for (std::size_t i = 0; i < reference.pixels.size(); i += 2)
        reference.pixels[i] = image.pixels[i];
    const Image<float> map = ssim_map(image, reference);
    for (int y = 5; y < 19; ++y)
        for (int x = 5; x < 27; ++x)
            ASSERT_NEAR(map(x, y), slow_ssim(image, reference, x, y), 1e-5);  // float, weights' sum
}

TEST(Ssim, TakesTheMeanUnderTheMask) {
    Image<EncodedRgb> image = grey(60, 20, 100);
    for (int y = 0; y < 20; ++y)
        for (int x = 40; x < 60; ++x)
            image(x, y) = {200, 200, 200};
    Mask left(60, 20, 0);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x)  // further from the change than a window reaches
            left(x, y) = 1;
    EXPECT_NEAR(ssim(image, grey(60, 20, 100), left), 1.0, 1e-6);
    EXPECT_LT(ssim(image, grey(60, 20, 100)), 0.99);
}

TEST(ImageErrors, RefuseSizesThatDiffer) {
    EXPECT_THROW(psnr(grey(4, 4, 0), grey(4, 5, 0)), Error);
    EXPECT_THROW(ssim(grey(4, 4, 0), grey(5, 4, 0)), Error);
    EXPECT_THROW(flip(grey(4, 4, 0), grey(4, 5, 0)), Error);
    EXPECT_THROW(psnr(Image<EncodedRgb>(), Image<EncodedRgb>()), Error);
}

}  // namespace
}  // namespace inlay
