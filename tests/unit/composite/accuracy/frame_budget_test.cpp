// What a budget is made of: noise is no allowance, and tracking cannot allow itself more.
#include "composite/accuracy/displacement.h"
#include "composite/accuracy/frame_verdict.h"
#include "composite/accuracy/irradiance_error.h"
#include "composite/accuracy/sensor_bounds.h"
#include "recordings/base/random.h"

#include <gmock/gmock.h>

#include <cmath>

namespace inlay {
namespace {

constexpr int width = 96, height = 64;

/// `mean` with noise of deviation s in each channel, uniform, on its own for every seed.
Image<Rgb> noisy(const Image<Rgb>& mean, double s, std::uint32_t seed) {
    Image<Rgb> image = mean;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.pixels[i][c] +=
                float(s * std::sqrt(12.0) *
                      (double(uniform({seed, 0, std::uint32_t(i), 0}, std::uint32_t(c))) - 0.5));
    return image;
}

Image<Rgb> flat(float value) { return Image<Rgb>(width, height, Rgb(value)); }

Reference reference_of(const Image<Rgb>& picture, double s) {
    return {picture, flat(float(s)), Mask(width, height, 1), Mask(width, height, 1), 0};
}

TEST(MeanSquareBeyondNoise, SeesTheDistanceAndNoNoise) {
    const Image<Rgb> a = noisy(flat(1), 0.5, 1), b = noisy(flat(1), 0.5, 2);
    const Mask all(width, height, 1);
    // The products' noise: 0.25 over the root of 18432 of them, 0.0018; four of these.
    EXPECT_NEAR(mean_square_beyond_noise(flat(1), a, b, all), 0, 0.008);
    // 0.3 off: the cross terms add 2 x 0.3 x 0.35 / 136.
    EXPECT_NEAR(mean_square_beyond_noise(flat(1.3f), a, b, all), 0.09, 0.015);
    EXPECT_EQ(mean_square_beyond_noise(flat(1.3f), a, b, Mask(width, height, 0)), 0);
}

TEST(Displacement, OfARampIsItsSlopeTimesTheShift) {
    Image<Rgb> ramp(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            ramp(x, y) = Rgb(0.01f * float(x));
    Reference truth = reference_of(ramp, 0);
    for (int y = 0; y < height; ++y)  // the last columns repeat the border
        for (int x = width - 8; x < width; ++x)
            truth.influenced(x, y) = 0;
    for (const double px : {0.25, 0.7, 1.0, 3.3})
        EXPECT_NEAR(std::sqrt(displaced_mean_square(truth, px)), 0.01 * px / std::sqrt(2.0),
                    1e-6);  // rounding of single precision
}

TEST(Displacement, OfNoiseAloneIsNothing) {
    const double s = 0.2;
    const Reference truth = reference_of(noisy(flat(1), s, 3), s);
    // A squared difference has about 2 s^2 = 0.08, which is taken out; its spread over the root of
    // 18432 of them, which overlap in threes, is 0.0015; three of these are left at most.
    for (const double px : {0.0, 0.3, 0.7, 1.5, 4.0})
        EXPECT_LT(displaced_mean_square(truth, px), 0.0045) << px;
}

TEST(Displacement, LeavesOutWhatIsNotFinite) {
    Reference truth = reference_of(flat(1), 0);
    truth.linear(40, 30) = Rgb(0);  // as a reference keeps what is not finite
    truth.finite(40, 30) = truth.influenced(40, 30) = 0;
    EXPECT_NEAR(displaced_mean_square(truth, 0.5), 0, 1e-13);  // rounding of single precision
    truth.influenced = Mask(width, height, 0);
    EXPECT_EQ(displaced_mean_square(truth, 0.5), 0);
}

Layers light(const Image<Rgb>& e_r, const Image<Rgb>& e_rv) {
    Layers layers;
    layers.m = Image<float>(width, height, 1.0f);
    layers.direct.e_r = e_r;
    layers.direct.e_rv_real = e_rv;
    layers.indirect.e_r = layers.indirect.e_rv_real = flat(0);
    return layers;
}

TEST(IrradianceError, SeesEachIrradianceAndNoNoiseOfTheReference) {
    const Layers a = light(noisy(flat(2), 0.4, 1), noisy(flat(1), 0.4, 2));
    const Layers b = light(noisy(flat(2), 0.4, 3), noisy(flat(1), 0.4, 4));
    const Layers found = light(flat(2.2f), flat(0.7f));
    const IrradianceError error = irradiance_error({found, found}, {a, b});
    // Noise of the mean square as above: 0.0012 and its cross terms, over the power.
    EXPECT_NEAR(error.e_r, 0.1, 0.01);
    EXPECT_NEAR(error.e_rv, 0.3, 0.01);
    EXPECT_EQ(error.compared, 1);
    // Two noisy estimates of the right light are right; one that stands for both is not.
    const Layers c = light(noisy(flat(2), 0.4, 5), noisy(flat(1), 0.4, 6));
    const Layers d = light(noisy(flat(2), 0.4, 7), noisy(flat(1), 0.4, 8));
    EXPECT_LT(irradiance_error({c, d}, {a, b}).e_r, 0.05);
    EXPECT_NEAR(irradiance_error({c, c}, {a, b}).e_r, 0.2, 0.02);
}

TEST(SensorBounds, FollowTheNoiseModelAndTheStatedTolerance) {
    const Lens lens{width, height, 100, 100, 47.5, 31.5};
    const Image<float> depth(width, height, 1.4f);
    const SensorBounds bounds = sensor_bounds(depth, lens, 0.008, true);
    // Nguyen et al. 2012 at 1.4 m: 1.2 mm + 1.9 mm; half a voxel is 4 mm; 0.8 px sideways, half a
    // pixel of turn; the slope of two depths that far off over two voxels.
    const double axial = 100 * 0.0031 / 1.4, place = 100 * 0.004 / 1.4;
    EXPECT_NEAR(bounds.displaced_px, std::sqrt(axial * axial + place * place + 0.8 * 0.8 + 0.25),
                1e-4);
    EXPECT_NEAR(bounds.model_px, std::hypot(place, 0.5), 1e-4);
    EXPECT_NEAR(bounds.tilt, std::atan(std::sqrt(2.0) * 0.0031 / 0.016), 1e-4);
    const SensorBounds exact = sensor_bounds(depth, lens, 0.008, false);
    EXPECT_LT(exact.displaced_px, bounds.displaced_px);
    EXPECT_LT(exact.tilt, 0.01);  // 0.06 mm of rounding over 16 mm
    EXPECT_EQ(sensor_bounds(Image<float>(4, 4, 0.0f), lens, 0.008, true).displaced_px, 0);
}

TEST(FrameVerdict, NamesTheFiguresThatAreOver) {
    FrameVerdict verdict;
    verdict.frame = 7;
    verdict.rmse = 0.02;
    verdict.light = {0.1, 0.2, 1};
    verdict.flicker = 0.01;
    verdict.budget.total = 0.03;
    verdict.budget.e_r = 0.15;
    verdict.budget.e_rv = 0.25;
    verdict.budget.flicker = 0.02;
    EXPECT_TRUE(keeps_budget(verdict));
    EXPECT_EQ(
        verdict_line(verdict),
        "frame 7: RMSE 0.0200 of 0.0300, E_R 0.1000 of 0.1500, E_RV 0.2000 of 0.2500, flicker "
        "0.0100 of 0.0200; within its budget");
    verdict.light.e_rv = 0.26;
    verdict.flicker = 0.03;
    EXPECT_FALSE(keeps_budget(verdict));
    EXPECT_THAT(verdict_line(verdict), testing::EndsWith("; over its budget: E_RV, flicker"));
    verdict.rmse = NAN;  // nothing that is known keeps a budget
    EXPECT_THAT(verdict_line(verdict), testing::EndsWith("; over its budget: RMSE, E_RV, flicker"));
}

}  // namespace
}  // namespace inlay
