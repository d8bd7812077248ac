// The simulated sensor: its statistics are those it names, and it drops what a sensor drops.
#include "recordings/synthetic/sensor_noise.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

const Lens kinect{.width = 200, .height = 150, .fx = 525, .fy = 525, .cx = 99.5, .cy = 74.5};

Image<float> wall(float z) { return Image<float>(kinect.width, kinect.height, z); }

double measured_pixels(const Image<float>& depth) {
    return double(
        std::count_if(depth.pixels.begin(), depth.pixels.end(), [](float z) { return z > 0; }));
}

double dropped_share(const Image<float>& depth) {
    return 1 - measured_pixels(depth) / double(depth.pixels.size());
}

/// A wall whose depth runs from 0.85 z to 1.15 z across the image, so that every phase of the
/// disparity steps occurs.
Image<float> slanted_wall(float z) {
    Image<float> depth = wall(z);
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x)
            depth(x, y) = z * (0.85f + 0.3f * (float(x) + float(y) / 150) / 200);
    return depth;
}

TEST(SensorNoise, ErrorsHaveTheMeasuredSigma) {
    for (const float z : {0.6f, 1.0f, 1.7f, 2.5f, 4.0f}) {
        const Image<float> exact = slanted_wall(z);
        const Image<float> measured = simulate_sensor(exact, kinect, {}, {.lateral_sigma = 0});
        // each error in units of its own sigma: the mean is 0, the variance 1
        double sum = 0;
        double squares = 0;
        for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
            ASSERT_GT(measured.pixels[i], 0);
            const double error =
                double(measured.pixels[i] - exact.pixels[i]) / double(axial_sigma(exact.pixels[i]));
            sum += error;
            squares += error * error;
        }
        const double count = double(exact.pixels.size());
        // 4 standard errors, 1 / sqrt(n) and 1 / sqrt(2 n). 0.02: rounding happens in 1 / z, whose
        // steps differ in depth by sigma / z (1 %) to both sides, and they are few at 4 m
        EXPECT_NEAR(sum / count, 0, 4 / std::sqrt(count) + 0.02) << z;
        EXPECT_NEAR(std::sqrt(squares / count), 1, 4 / std::sqrt(2 * count) + 0.02) << z;
    }
}

TEST(SensorNoise, DropsNothingOfAWallSeenFromTheFront) {
    EXPECT_EQ(measured_pixels(simulate_sensor(wall(2.0f), kinect, {})), 30'000);
}

TEST(SensorNoise, SigmaIsNguyensFormula) {
    EXPECT_FLOAT_EQ(axial_sigma(0.4f), 0.0012f);
    EXPECT_FLOAT_EQ(axial_sigma(2.4f), 0.0012f + 0.0019f * 4);
}

TEST(SensorNoise, DisparityComesInSteps) {
    const Image<float> measured = simulate_sensor(wall(3.0f), kinect, {}, {.depth_unit = 0});
    for (const float z : measured.pixels) {
        const double steps = 525 * 0.075 / double(z) / 0.125;
        ASSERT_NEAR(steps, std::round(steps), 1e-4);  // float rounding of 105 steps
    }
}

TEST(SensorNoise, DepthIsAWholeNumberOfUnits) {
    for (const float z : simulate_sensor(wall(1.3f), kinect, {}).pixels)
        ASSERT_NEAR(z * 5000, std::round(z * 5000), 1e-2);  // float: 6500 units x 2^-24 x some
}

TEST(SensorNoise, WithoutNoiseItMeasuresExactly) {
    const DepthNoiseSettings none{.axial_floor = 0,
                                  .axial_growth = 0,
                                  .lateral_sigma = 0,
                                  .disparity_step = 0,
                                  .depth_unit = 0};
    EXPECT_EQ(simulate_sensor(wall(1.5f), kinect, {}, none).pixels, wall(1.5f).pixels);
}

/// The left half is at 1 m, the right half at 2 m.
Image<float> step_scene() {
    Image<float> depth = wall(1.0f);
    for (int y = 0; y < depth.height; ++y)
        for (int x = 100; x < depth.width; ++x)
            depth(x, y) = 2.0f;
    return depth;
}

TEST(SensorNoise, DropsPixelsAtDepthEdgesAndOnlyThere) {
    const Image<float> measured = simulate_sensor(step_scene(), kinect, {});
    int at_edge = 0;
    for (int y = 0; y < measured.height; ++y)
        for (int x = 0; x < measured.width; ++x) {
            if (measured(x, y) > 0) continue;
            EXPECT_TRUE(x == 99 || x == 100) << x;
            ++at_edge;
        }
    // binomial: 300 pixels, probability 0.6, 4 standard deviations of 8.5
    EXPECT_NEAR(at_edge, 180, 34);
}

TEST(SensorNoise, LateralNoiseMixesTheSidesOfAnEdgeButInventsNoDepth) {
    const Image<float> measured = simulate_sensor(step_scene(), kinect, {});
    int swapped = 0;
    for (int y = 0; y < measured.height; ++y)
        for (int x = 90; x < 110; ++x) {
            const float z = measured(x, y);
            if (z == 0) continue;
            // 8 sigma of each plane's axial noise
            const bool near_plane = std::abs(z - 1) < 8 * axial_sigma(1);
            const bool far_plane = std::abs(z - 2) < 8 * axial_sigma(2);
            ASSERT_TRUE(near_plane || far_plane) << z;
            swapped += (x < 100) != near_plane ? 1 : 0;
        }
    EXPECT_GT(swapped, 0);
}

/// A plane through (0, 0, 1.5) whose normal is turned by `angle` (rad) about the x axis.
Image<float> tilted_plane(double angle) {
    Image<float> depth = wall(0);
    for (int y = 0; y < depth.height; ++y) {
        const double v = (y - kinect.cy) / kinect.fy;
        for (int x = 0; x < depth.width; ++x)
            depth(x, y) = float(1.5 / (1 + v * std::tan(angle)));
    }
    return depth;
}

TEST(SensorNoise, DropsMoreTheMoreGrazingTheView) {
    const auto share = [](double degrees) {
        const auto plane = tilted_plane(degrees * std::numbers::pi / 180);
        return dropped_share(simulate_sensor(plane, kinect, {}, {.farthest = 1000}));
    };
    EXPECT_EQ(share(50), 0.0);  // the field of view adds 8 degrees, which stays below 70
    // at 77.5 degrees half of the range is behind: on average about half is dropped; rows at the
    // image's border see the plane up to 8 degrees steeper or flatter
    EXPECT_NEAR(share(77.5), 0.5, 0.1);
    EXPECT_LT(share(72), share(76));
    EXPECT_LT(share(76), share(80));
}

TEST(SensorNoise, KeepsHolesAndTheRange) {
    Image<float> depth = wall(1.0f);
    for (int x = 0; x < depth.width; ++x)
        for (int y = 0; y < 50; ++y)
            depth(x, y) = 0;
    const Image<float> measured = simulate_sensor(depth, kinect, {});
    for (int x = 0; x < depth.width; ++x)
        EXPECT_EQ(measured(x, 20), 0);
    EXPECT_EQ(dropped_share(simulate_sensor(wall(0.3f), kinect, {})), 1.0);
    EXPECT_EQ(dropped_share(simulate_sensor(wall(9.0f), kinect, {})), 1.0);
}

TEST(SensorNoise, DependsOnSeedAndFrameAndNothingElse) {
    const Image<float> depth = wall(2.0f);
    const auto once = simulate_sensor(depth, kinect, {.seed = 3, .frame = 7}).pixels;
    set_thread_count(1);
    EXPECT_EQ(simulate_sensor(depth, kinect, {.seed = 3, .frame = 7}).pixels, once);
    set_thread_count(0);
    EXPECT_NE(simulate_sensor(depth, kinect, {.seed = 3, .frame = 8}).pixels, once);
    EXPECT_NE(simulate_sensor(depth, kinect, {.seed = 4, .frame = 7}).pixels, once);
}

TEST(SensorNoise, RefusesBadSettingsAndSizes) {
    EXPECT_THROW(validate(DepthNoiseSettings{.baseline = 0}), Error);
    EXPECT_THROW(validate(DepthNoiseSettings{.edge_dropout = 1.5f}), Error);
    EXPECT_THROW(validate(DepthNoiseSettings{.nearest = 9}), Error);
    EXPECT_THROW(simulate_sensor(Image<float>(3, 3), kinect, {}), Error);
}

}  // namespace
}  // namespace inlay
