// Where E_RV - E_R was sampled for itself: what the filter makes of it, and of frames that differ.
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"
#include "tests/support/filter_scenes.h"
#include "tests/support/matchers.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

using namespace test;

constexpr double spacing = 0.02;  // m
constexpr double bandwidth = 4;   // 1/rad

/// Noise in E_R, and E_RV = E_R + `change`.
NoisyLayers plane_with_change(std::uint32_t seed, const Rgb& change, float rate = 2) {
    NoisyLayers layers = noisy_plane(48, 36, spacing, seed);
    layers.change_rates.direct = layers.change_rates.indirect = Image<float>(48, 36, rate);
    for (Irradiance* light : {&layers.direct, &layers.indirect})
        for (std::size_t i = 0; i < light->e_r.pixels.size(); ++i)
            light->e_rv_real.pixels[i] = light->e_r.pixels[i] + change;
    return layers;
}

TEST(ChangeLayers, NoChangeLeavesBothModesTheSameBits) {
    const NoisyLayers now = plane_with_change(1, Rgb(0)), before = plane_with_change(9, Rgb(0));
    for (const NoisyLayers* previous : {static_cast<const NoisyLayers*>(nullptr), &before}) {
        const Layers layers = filter_layers(now, previous, bandwidth, {});
        EXPECT_TRUE(same_bytes(layers.direct.e_r, layers.direct.e_rv_real));
        EXPECT_TRUE(same_bytes(layers.indirect.e_r, layers.indirect.e_rv_real));
    }
}

/// A constant keeps its value under any weights; float sums of 31 x 31 pixels err below 1e-5.
TEST(ChangeLayers, AConstantChangeStaysWhateverTheNoiseOfTheRest) {
    const Rgb change(0.25f, 0.5f, 1);
    const NoisyLayers now = plane_with_change(1, change), before = plane_with_change(9, change);
    const Layers layers = filter_layers(now, &before, bandwidth, {});
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i)
        EXPECT_TRUE(
            near(layers.direct.e_rv_real.pixels[i] - layers.direct.e_r.pixels[i], change, 1e-5));
}

/// More may be taken away than the few samples of E_R brought.
TEST(ChangeLayers, LightIsNeverNegative) {
    const Layers layers = filter_layers(plane_with_change(1, Rgb(-2)), nullptr, bandwidth, {});
    for (const Rgb& c : layers.direct.e_rv_real.pixels)
        EXPECT_EQ(c, Rgb(0));
}

TEST(ChangeLayers, ItsOwnRateNarrowsTheChangeAlone) {
    NoisyLayers now = plane_with_change(1, Rgb(0));
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i)
        now.direct.e_rv_real.pixels[i] += random_rgb(77, std::uint32_t(i));
    NoisyLayers narrow = now;
    narrow.change_rates.direct = Image<float>(48, 36, 1e6f);
    const Layers a = filter_layers(now, nullptr, bandwidth, {});
    const Layers b = filter_layers(narrow, nullptr, bandwidth, {});
    EXPECT_TRUE(same_bytes(a.direct.e_r, b.direct.e_r));
    EXPECT_FALSE(same_bytes(a.direct.e_rv_real, b.direct.e_rv_real));
    EXPECT_TRUE(same_bytes(a.indirect, b.indirect));
}

/// An occluder that touches bounds the width from below alone: in pixels, and with the samples.
TEST(ChangeLayers, ATouchingOccluderLeavesTheNarrowestWidthOfItsSamples) {
    FilterSettings settings;
    settings.narrowest_change = 0.5;
    NoisyLayers layers = plane_with_change(1, Rgb(0.5f), 1e6f);
    for (const int samples : {16, 256}) {
        layers.samples = samples;
        const double width = settings.narrowest_change * spacing * (samples == 16 ? 1 : 0.5);
        EXPECT_NEAR(
            filter_layers(layers, nullptr, bandwidth, settings).bandwidth_direct(24, 18) * width, 1,
            0.01);  // the camera sees the plane's pixels within 1 % of evenly spaced
    }
}

TEST(ChangeLayers, AFrameThatWasSampledAnotherWayAddsNothing) {
    const NoisyLayers apart = plane_with_change(1, Rgb(0.5f));
    const NoisyLayers together = noisy_plane(48, 36, spacing, 5);
    EXPECT_TRUE(same_bytes(filter_layers(apart, &together, bandwidth, {}).direct,
                           filter_layers(apart, nullptr, bandwidth, {}).direct));
    EXPECT_TRUE(same_bytes(filter_layers(together, &apart, bandwidth, {}).direct,
                           filter_layers(together, nullptr, bandwidth, {}).direct));
}

TEST(ChangeLayers, RatesOfAnotherSizeAreRefused) {
    NoisyLayers layers = plane_with_change(1, Rgb(0));
    layers.change_rates.indirect = Image<float>(47, 36, 1.0f);
    EXPECT_THROW(filter_layers(layers, nullptr, bandwidth, {}), Error);
}

}  // namespace
}  // namespace inlay
