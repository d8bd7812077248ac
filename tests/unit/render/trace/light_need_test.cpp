// LightNeed: how many samples of E_R a pixel takes, by what changes and by what is around it.
#include "render/trace/light_need.h"

#include <gtest/gtest.h>

#include <numbers>

namespace inlay::test {
namespace {

/// Of 64 samples, under a sky of 2, where direct light changes by the share `share` of an open
/// surface's.
int samples_at(float share, float hidden = 0, int most = 64) {
    return samples_for(light_need(hidden, Rgb(-share * 2 * std::numbers::pi_v<float>), 2), most);
}

TEST(LightNeed, GetsMoreSamplesWhereAChangeIsPlainlySeen) {
    EXPECT_EQ(samples_at(0.1f), 64);
    EXPECT_EQ(samples_at(0.03f), 16);
    EXPECT_EQ(samples_at(0.001f), 4);
    EXPECT_EQ(samples_at(0, 0, 16), 1);
}

TEST(LightNeed, WhatHidesTheSkyCountsAsAChange) {
    EXPECT_EQ(samples_at(0, 0.1f), 64);
    EXPECT_EQ(samples_at(0.04f, 0.04f), 64);
    EXPECT_EQ(samples_at(0, 0.03f), 16);
}

TEST(LightNeed, GetsOneSampleAtLeast) {
    EXPECT_EQ(samples_at(0, 0, 1), 1);
    EXPECT_EQ(samples_at(0, 0, 3), 1);
    EXPECT_EQ(samples_at(1, 0, 1), 1);
}

/// 3 x 3 pixels of a plane that is seen at right angles, without any change.
NoisyLayers plane_of_nine() {
    NoisyLayers layers;
    layers.m = Image<float>(3, 3, 1.0f);
    layers.direct.e_rv_real = Image<Rgb>(3, 3, Rgb(0));
    layers.change_rates.share = Image<float>(3, 3, 0.0f);
    layers.real.object = Image<std::uint32_t>(3, 3, 1);
    layers.real.position = Image<glm::vec3>(3, 3);
    layers.real.normal = Image<glm::vec3>(3, 3, glm::vec3(0, 0, -1));
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x)
            layers.real.position(x, y) = {0.002f * float(x), 0.002f * float(y), 1};
    return layers;
}

LightNeed middle_of(const NoisyLayers& layers) { return light_needs(layers, 1)(1, 1); }

TEST(LightNeed, IsSmallAmidAPlaneAndOnTheSideOfAnEdge) {
    NoisyLayers layers = plane_of_nine();
    EXPECT_EQ(middle_of(layers), LightNeed::hardly);
    for (int y = 0; y < 3; ++y)
        layers.real.position(2, y).z = 2;
    EXPECT_EQ(middle_of(layers), LightNeed::hardly);
}

TEST(LightNeed, GrowsWithoutNeighborsToMixWith) {
    NoisyLayers layers = plane_of_nine();
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; x += 2)
            layers.real.position(x, y).z = 2;  // a line of pixels is left
    EXPECT_EQ(middle_of(layers), LightNeed::slight);
    layers.real.normal(1, 0) = glm::normalize(glm::vec3(1, 0, -1));
    EXPECT_EQ(middle_of(layers), LightNeed::plain);
    layers = plane_of_nine();
    for (int i = 0; i < 9; ++i)
        if (i != 4) layers.real.object.pixels[std::size_t(i)] = 0;
    EXPECT_EQ(middle_of(layers), LightNeed::plain);
}

TEST(LightNeed, NormalsThatAreNoNumbersAreNoNeighbors) {
    NoisyLayers layers = plane_of_nine();
    layers.real.normal(1, 1) = glm::vec3(NAN);
    EXPECT_EQ(middle_of(layers), LightNeed::plain);
}

}  // namespace
}  // namespace inlay::test
