// Which layer is smoothed with what, and how frames meet.
#include "render/filter/filter_layers.h"

#include "recordings/base/check.h"
#include "render/filter/receiver_planes.h"
#include "tests/support/filter_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

using namespace test;

constexpr double spacing = 0.02;  // m
const FilterSettings defaults;

FilterSettings without_temporal() {
    FilterSettings s;
    s.temporal = false;
    return s;
}

void fill_light(NoisyLayers& layers, const Rgb& on_real, const Rgb& on_virtual) {
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        const bool real = layers.real.object.pixels[i] != 0;
        const bool ball = layers.virtual_.object.pixels[i] != 0;
        for (Irradiance* light : {&layers.direct, &layers.indirect}) {
            light->e_r.pixels[i] = light->e_rv_real.pixels[i] = real ? on_real : Rgb(0);
            light->e_rv_virtual.pixels[i] = ball ? on_virtual : Rgb(0);
        }
        layers.s_rv.pixels[i] = ball ? on_virtual : Rgb(0);
    }
}

NoisyLayers plane_and_ball(std::uint32_t seed) {
    NoisyLayers layers = noisy_plane(64, 48, spacing, seed);
    add_ball(layers, 0.3, seed + 10);
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        const float c = 5 * random_rgb(seed + 20, std::uint32_t(i)).x;
        layers.real.occluder_direct.pixels[i] = layers.virtual_.occluder_direct.pixels[i] = c;
        layers.real.occluder_indirect.pixels[i] = layers.virtual_.occluder_indirect.pixels[i] = c;
    }
    return layers;
}

TEST(FilterLayers, KeepsConstantLightToTheBit) {
    NoisyLayers now = plane_and_ball(1), before = plane_and_ball(2);
    fill_light(now, Rgb(0.1f, 2, 3.3f), Rgb(0.7f, 1e-4f, 40));
    fill_light(before, Rgb(0.1f, 2, 3.3f), Rgb(0.7f, 1e-4f, 40));
    const Layers smooth = filter_layers(now, &before, 9, defaults);
    EXPECT_TRUE(same_bits(smooth.direct, now.direct));
    EXPECT_TRUE(same_bits(smooth.indirect, now.indirect));
    EXPECT_TRUE(same_bits(smooth.s_rv, now.s_rv));
}

TEST(FilterLayers, CopiesTheNoiseWhenSwitchedOff) {
    const NoisyLayers now = plane_and_ball(3), before = plane_and_ball(4);
    FilterSettings off;
    off.enabled = false;
    const Layers copy = filter_layers(now, &before, 9, off);
    EXPECT_TRUE(same_bits(copy.direct, now.direct));
    EXPECT_TRUE(same_bits(copy.indirect, now.indirect));
    EXPECT_TRUE(same_bits(copy.s_rv, now.s_rv));
}

TEST(FilterLayers, PassesCoverageAndAlbedoThrough) {
    NoisyLayers now = plane_and_ball(5);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        now.m.pixels[i] = random_rgb(1, std::uint32_t(i)).x;
        now.k_v.pixels[i] = random_rgb(2, std::uint32_t(i));
    }
    const Layers smooth = filter_layers(now, nullptr, 9, defaults);
    EXPECT_TRUE(same_bits(smooth.m, now.m));
    EXPECT_TRUE(same_bits(smooth.k_v, now.k_v));
}

TEST(FilterLayers, LeavesEqualModesEqualToTheBitBeyondTheReachOfAChange) {
    NoisyLayers now = plane_and_ball(6), before = plane_and_ball(7);
    for (NoisyLayers* frame : {&now, &before}) {
        frame->direct.e_rv_real = frame->direct.e_r;
        frame->indirect.e_rv_real = frame->indirect.e_r;
        for (int y = 20; y < 24; ++y) {
            for (int x = 30; x < 35; ++x)
                frame->direct.e_rv_real(x, y) *= 0.5f;
        }
    }
    FilterSettings s;
    s.kernel_radius = 6;
    const Layers smooth = filter_layers(now, &before, 9, s);
    EXPECT_TRUE(same_bits(smooth.indirect.e_r, smooth.indirect.e_rv_real));
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            const bool reached = x >= 24 && x < 41 && y >= 14 && y < 30;
            const bool equal = smooth.direct.e_r(x, y) == smooth.direct.e_rv_real(x, y);
            EXPECT_TRUE(reached || equal) << x << ' ' << y;
        }
    }
    EXPECT_NE(smooth.direct.e_r(32, 22), smooth.direct.e_rv_real(32, 22));
}

TEST(FilterLayers, KeepsTheRatioAtSilhouettesFreeOfTheVirtualSurface) {
    // The shadow leaves 0.8 of the light on real surfaces; the virtual ball beside them gets 0.3.
    // One sum of E_RV over all hits, as in the thesis's Algorithm 1, gives 1.1 where both share a
    // pixel evenly: (0.8 + 0.3) / 1.
    NoisyLayers now = plane_and_ball(8);
    fill_light(now, Rgb(1), Rgb(0.3f));
    for (Rgb& e : now.direct.e_rv_real.pixels)
        e = Rgb(0.8f);
    const Layers smooth = filter_layers(now, nullptr, 9, defaults);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i)
        EXPECT_EQ(smooth.direct.e_rv_real.pixels[i] / smooth.direct.e_r.pixels[i], Rgb(0.8f));
}

TEST(FilterLayers, GivesNothingWhereThereIsNoReceiver) {
    NoisyLayers now = noisy_plane(32, 32, spacing, 9);
    for (int y = 10; y < 20; ++y) {
        for (int x = 5; x < 9; ++x) {
            now.real.object(x, y) = 0;
            now.direct.e_r(x, y) = Rgb(1e6f);  // must not leak
        }
    }
    const Layers smooth = filter_layers(now, nullptr, 9, defaults);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const bool hole = now.real.object(x, y) == 0;
            EXPECT_EQ(smooth.direct.e_r(x, y) == Rgb(0), hole);
            EXPECT_LT(smooth.direct.e_r(x, y).x, 1.0f);
            EXPECT_EQ(smooth.direct.e_rv_virtual(x, y), Rgb(0));
        }
    }
}

TEST(FilterLayers, NarrowsTheFilterWithCloserOccludersAndSharperLight) {
    NoisyLayers now = noisy_plane(16, 16, spacing, 10);
    double last = -1;
    for (const double c : {0.0, 0.1, 1.0, 3.0}) {
        for (float& rate : now.real.occluder_direct.pixels)
            rate = float(c);
        const Layers smooth = filter_layers(now, nullptr, 9, defaults);
        const double inverse_width = double(smooth.bandwidth_direct(8, 8));
        EXPECT_NEAR(inverse_width, c * (2.36 + 9), 1e-5 * c * 12);  // single precision
        EXPECT_GT(inverse_width, last);
        EXPECT_EQ(smooth.bandwidth_indirect(8, 8), 0.0f);
        last = inverse_width;
    }
    for (float& rate : now.real.occluder_direct.pixels)
        rate = 1e6f;
    const Layers bounded = filter_layers(now, nullptr, 9, defaults);
    EXPECT_NEAR(double(bounded.bandwidth_direct(8, 8)) * spacing, 1, 1e-4);  // one pixel's width
}

TEST(FilledRates, AreTheMeanOfWhatNeighborsOfTheSameObjectKnow) {
    Image<float> rates(9, 3, 0.0f);
    Image<std::uint32_t> object(9, 3, 1);
    rates(2, 1) = 2;
    rates(4, 2) = 4;
    rates(5, 1) = 100;
    object(5, 1) = 2;
    object(0, 0) = 0;
    const Image<float> filled = filled_rates(rates, object, 2);
    EXPECT_EQ(filled(3, 1), 3.0f);
    EXPECT_EQ(filled(0, 1), 2.0f);
    EXPECT_EQ(filled(2, 1), 2.0f);  // its own stays
    EXPECT_EQ(filled(7, 1), 0.0f);  // nobody within reach knows
    EXPECT_EQ(filled(0, 0), 0.0f);  // no object
    EXPECT_EQ(filled_rates(rates, object, 0).pixels, rates.pixels);
}

TEST(FilterLayers, ReportsTheWidthOfTheKindThatCoversMore) {
    const NoisyLayers now = plane_and_ball(11);
    const Layers smooth = filter_layers(now, nullptr, 0, defaults);
    // the ball's curvature alone: 1 / 0.3 m x 2.36 / 0.2, bounded by one pixel of 0.02 m at most
    EXPECT_GT(smooth.bandwidth_direct(32, 24), 0.9 * 2.36 / 0.2 / 0.3);
    EXPECT_LT(smooth.bandwidth_direct(2, 2), 5.1 * 2.36);  // the plane: c is below 5
}

TEST(FilterLayers, KeepsGlossyRadianceAsItIsWithoutAGlossySurface) {
    NoisyLayers now = plane_and_ball(12);
    for (float& b : now.glossy_bandwidth.pixels)
        b = 0;
    EXPECT_TRUE(same_bits(filter_layers(now, nullptr, 9, defaults).s_rv, now.s_rv));
}

TEST(FilterLayers, SmoothsGlossyRadianceLessThanDiffuse) {
    NoisyLayers now = plane_and_ball(13);
    for (float& rate : now.virtual_.occluder_direct.pixels)
        rate = 0;
    for (float& rate : now.virtual_.occluder_indirect.pixels)
        rate = 0;
    for (float& bandwidth : now.glossy_bandwidth.pixels)
        bandwidth = bandwidth > 0 ? 0.5f : 0.0f;  // a lobe so wide that pixels share it
    now.direct.e_rv_virtual = now.s_rv;
    const Layers smooth = filter_layers(now, nullptr, 9, defaults);
    double diffuse = 0, glossy = 0;
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        diffuse += std::abs(double(smooth.direct.e_rv_virtual.pixels[i].x - now.s_rv.pixels[i].x));
        glossy += std::abs(double(smooth.s_rv.pixels[i].x - now.s_rv.pixels[i].x));
    }
    EXPECT_LT(glossy, diffuse);
    EXPECT_GT(glossy, 0);
}

TEST(FilterLayers, LeavesAHighlightNarrowerThanAPixelAlone) {
    NoisyLayers now = plane_and_ball(13);
    for (float& bandwidth : now.glossy_bandwidth.pixels)
        bandwidth = bandwidth > 0 ? 1e6f : 0.0f;
    const Layers smooth = filter_layers(now, nullptr, 9, defaults);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i)
        ASSERT_EQ(smooth.s_rv.pixels[i], now.s_rv.pixels[i]);
}

/// The mean square deviation from 1/2 of E_R's direct light, which is uniform noise in 0..1.
double noise_left(const Layers& layers) {
    double sum = 0;
    for (const Rgb& e : layers.direct.e_r.pixels) {
        const glm::dvec3 off = glm::dvec3(e) - 0.5;
        sum += glm::dot(off, off);
    }
    return sum / double(3 * layers.direct.e_r.pixels.size());
}

TEST(TemporalFilter, HalvesTheVarianceOfAStillView) {
    const NoisyLayers now = noisy_plane(96, 96, spacing, 20),
                      before = noisy_plane(96, 96, spacing, 30);
    FilterSettings s;
    s.kernel_radius = 1;
    // 9 against 18 independent values per pixel; 5 % is 4 standard errors of the 3 x 96^2 / 9
    // values that do not share a kernel
    EXPECT_NEAR(noise_left(filter_layers(now, &before, 9, s)) /
                    noise_left(filter_layers(now, nullptr, 9, s)),
                0.5, 0.05);
}

TEST(TemporalFilter, FindsTheSamePlaceAfterTheCameraMoved) {
    // The previous camera stood five pixels to the right: its image shows this one's left part
    // five pixels further left. Light differs from place to place, so a wrong match would show.
    const int shift = 5;
    NoisyLayers now = noisy_plane(64, 48, spacing, 21);
    NoisyLayers before = now;
    before.world_from_camera.translation.x += shift * spacing;
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::dvec2 ground = ground_of(now, x, y);
            now.direct.e_r(x, y) = Rgb(float(10 + ground.x));
            before.direct.e_r(x, y) = Rgb(float(10 + ground.x + shift * spacing));
            before.real.position(x, y).x += float(shift * spacing);
        }
    }
    FilterSettings s;
    s.kernel_radius = 0;  // only the pixel and its match: the mean is exact where they agree
    const Layers smooth = filter_layers(now, &before, 9, s);
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 64; ++x)  // 1e-6 x 10: single precision
            EXPECT_NEAR(smooth.direct.e_r(x, y).x, now.direct.e_r(x, y).x, 1e-5);
    }
}

TEST(TemporalFilter, RejectsWhatDoesNotFit) {
    const NoisyLayers now = noisy_plane(32, 24, spacing, 22);
    const Layers alone = filter_layers(now, nullptr, 9, defaults);
    NoisyLayers turned = now, lifted = now, other = now, away = now;
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        for (NoisyLayers* frame : {&turned, &lifted, &other, &away})
            frame->direct.e_r.pixels[i] = Rgb(100);
        turned.real.normal.pixels[i] = {0.6f, 0, 0.8f};
        lifted.real.position.pixels[i].z += float(5 * spacing);
        other.real.object.pixels[i] = 2;
    }
    away.world_from_camera.translation.x += 100;  // m: no overlap
    for (const NoisyLayers* frame : {&turned, &lifted, &other, &away})
        EXPECT_TRUE(same_bits(filter_layers(now, frame, 9, defaults), alone));
}

TEST(TemporalFilter, IsLeftOutWhenSwitchedOff) {
    const NoisyLayers now = plane_and_ball(23), before = plane_and_ball(24);
    const Layers off = filter_layers(now, &before, 9, without_temporal());
    EXPECT_TRUE(same_bits(off, filter_layers(now, nullptr, 9, defaults)));
    EXPECT_FALSE(same_bits(off, filter_layers(now, &before, 9, defaults)));
}

TEST(FilterLayers, RefusesImagesOfOtherSizes) {
    NoisyLayers now = noisy_plane(8, 8, spacing, 25);
    now.indirect.e_rv_real = Image<Rgb>(8, 7);
    EXPECT_THROW(filter_layers(now, nullptr, 9, defaults), Error);
    const NoisyLayers good = noisy_plane(8, 8, spacing, 25);
    EXPECT_THROW(filter_layers(good, &now, 9, defaults), Error);
    EXPECT_THROW(filter_layers(good, nullptr, NAN, defaults), Error);
    EXPECT_THROW(filter_layers(good, nullptr, -1, defaults), Error);
}

}  // namespace
}  // namespace inlay
