// E_R for itself: how many samples a pixel takes of it.
#include "render/trace/real_light.h"

#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace inlay::test {
namespace {

/// Samples of a pixel whose direct light changes by the share `share` of an open surface's.
int samples_at(float share, int primary, int secondary, float hidden = 0) {
    const EnvironmentSampler sky = constant_environment(2);
    const RealGeometry none = no_real_geometry();
    const EmbreeScene empty;
    const TwoModeScene scene{telescope(1, 1), {}, none, empty, sky};
    SamplingSettings settings;
    settings.primary = primary;
    settings.secondary = secondary;
    return real_light_samples(scene, settings, hidden, Rgb(-share * 2 * std::numbers::pi_v<float>));
}

TEST(RealLight, GetsMoreSamplesWhereAChangeIsPlainlySeen) {
    EXPECT_EQ(samples_at(0.1f, 4, 16), 64);
    EXPECT_EQ(samples_at(0.03f, 4, 16), 16);
    EXPECT_EQ(samples_at(0.001f, 4, 16), 4);
    EXPECT_EQ(samples_at(0, 4, 4), 1);
}

TEST(RealLight, WhatHidesTheSkyCountsAsAChange) {
    EXPECT_EQ(samples_at(0, 4, 16, 0.1f), 64);
    EXPECT_EQ(samples_at(0.04f, 4, 16, 0.04f), 64);
    EXPECT_EQ(samples_at(0, 4, 16, 0.03f), 16);
}

TEST(RealLight, GetsOneSampleAtLeast) {
    EXPECT_EQ(samples_at(0, 1, 1), 1);
    EXPECT_EQ(samples_at(0, 1, 3), 1);
    EXPECT_EQ(samples_at(1, 1, 1), 1);
}

}  // namespace
}  // namespace inlay::test
