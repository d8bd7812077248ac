// E_R is needed as far as kernels reach from a change, and nowhere else.
#include "render/filter/light_demand.h"

#include "tests/support/filter_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace inlay {
namespace {

constexpr int width = 48, height = 36;
constexpr double spacing = 0.02;  // m

NoisyLayers plane(bool apart) {
    NoisyLayers layers = test::noisy_plane(width, height, spacing, 1);
    layers.direct.e_rv_real = layers.direct.e_r;
    layers.indirect.e_rv_real = layers.indirect.e_r;
    if (apart)
        layers.change_rates.direct = layers.change_rates.indirect = Image<float>(width, height);
    return layers;
}

Image<std::uint8_t> touched_at(glm::ivec2 p) {
    Image<std::uint8_t> touched(width, height, 0);
    touched(p.x, p.y) = 1;
    return touched;
}

FilterSettings narrow() {
    FilterSettings settings;
    settings.kernel_radius = 3;
    settings.rate_reach = 2;
    return settings;
}

/// Twice the kernel (the change is smoothed, then E_R is read), and the reach of rates.
constexpr int reach = 3 + 3 + 2;

TEST(LightDemand, ReachesTwoKernelsAndTheRatesFromEveryChange) {
    for (const glm::ivec2 p : {glm::ivec2(20, 17), glm::ivec2(0, 0), glm::ivec2(47, 35)}) {
        const auto needed = light_demand(touched_at(p), plane(true), nullptr, narrow());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                EXPECT_EQ(needed(x, y) != 0,
                          std::abs(x - p.x) <= reach && std::abs(y - p.y) <= reach)
                    << x << ", " << y;
    }
}

TEST(LightDemand, WithoutAChangeNothingIsNeeded) {
    const Image<std::uint8_t> nowhere(width, height, 0);
    const NoisyLayers now = plane(true), before = plane(true);
    for (const NoisyLayers* previous : {static_cast<const NoisyLayers*>(nullptr), &before}) {
        const auto needed = light_demand(nowhere, now, previous, narrow());
        EXPECT_EQ(std::count(needed.pixels.begin(), needed.pixels.end(), 0), width * height);
    }
}

TEST(LightDemand, WithoutTheFilterOnlyTheChangedPixelsAreNeeded) {
    FilterSettings off = narrow();
    off.enabled = false;
    EXPECT_EQ(light_demand(touched_at({20, 17}), plane(true), nullptr, off).pixels,
              touched_at({20, 17}).pixels);
}

TEST(LightDemand, FollowsTheChangeOfTheFrameBefore) {
    NoisyLayers before = plane(true);
    before.direct.e_rv_real(30, 10) += Rgb(1);
    const auto needed = light_demand(touched_at({5, 5}), plane(true), &before, narrow());
    EXPECT_NE(needed(30, 10), 0);
    EXPECT_NE(needed(30 + reach, 10), 0);
    EXPECT_EQ(needed(30 + reach + 1, 10), 0);
    EXPECT_NE(needed(5, 5), 0);
}

TEST(LightDemand, SharedSamplesAreAllNeededForTheNextFrame) {
    const auto needed = light_demand(touched_at({5, 5}), plane(false), nullptr, narrow());
    EXPECT_EQ(std::count(needed.pixels.begin(), needed.pixels.end(), 0), 0);
    FilterSettings alone = narrow();
    alone.temporal = false;
    EXPECT_EQ(light_demand(touched_at({5, 5}), plane(false), nullptr, alone)(47, 35), 0);
}

}  // namespace
}  // namespace inlay
