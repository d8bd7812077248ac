// What every baseline must keep, and what each one's kernel promises.
#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "render/baseline/a_trous.h"
#include "render/baseline/gaussian_irradiance.h"
#include "render/baseline/gaussian_ratio.h"
#include "render/baseline/guided_filter.h"
#include "render/baseline/joint_bilateral.h"
#include "render/baseline/non_local_means.h"
#include "tests/support/filter_scenes.h"
#include "tests/support/matchers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace inlay::test {
namespace {

constexpr double spacing = 0.02;  // m

struct Method {
    std::string name;
    std::function<Layers(const NoisyLayers&)> smooth;
    int reach = 0;               // px beyond which nothing is mixed
    bool guided = false;         // stops where normals turn
    bool keeps_ratio = true;     // hands on irradiances, not a ratio
    bool keeps_shadows = false;  // stops where the light changes
};

std::vector<Method> methods() {
    return {
        {"gaussian_irradiance", [](const NoisyLayers& n) { return gaussian_irradiance(n, 2); }, 6},
        {"gaussian_ratio", [](const NoisyLayers& n) { return gaussian_ratio(n, 2); }, 6, false,
         false},
        {"joint_bilateral", [](const NoisyLayers& n) { return joint_bilateral(n, 3); }, 6, true},
        {"guided_filter", [](const NoisyLayers& n) { return guided_filter(n, 3); }, 6, true},
        {"non_local_means", [](const NoisyLayers& n) { return non_local_means(n, 1); }, 7, false,
         true, true},
        // 2 + 4 px of two levels, and 4 of the variance at the pixels that these reach
        {"a_trous", [](const NoisyLayers& n) { return a_trous(n, 2); }, 6, true, true, true},
    };
}

NoisyLayers plane_and_ball(std::uint32_t seed) {
    NoisyLayers layers = noisy_plane(64, 48, spacing, seed);
    add_ball(layers, 0.3, seed + 10);
    return layers;
}

void fill_light(NoisyLayers& layers, const Rgb& e_r, const Rgb& e_rv, const Rgb& on_virtual) {
    for (Irradiance* light : {&layers.direct, &layers.indirect}) {
        for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
            const bool real = layers.real.object.pixels[i] != 0;
            const bool ball = layers.virtual_.object.pixels[i] != 0;
            light->e_r.pixels[i] = real ? e_r : Rgb(0);
            light->e_rv_real.pixels[i] = real ? e_rv : Rgb(0);
            light->e_rv_virtual.pixels[i] = ball ? on_virtual : Rgb(0);
        }
    }
}

TEST(Baselines, KeepConstantLightToTheBit) {
    NoisyLayers now = plane_and_ball(1);
    fill_light(now, Rgb(0.1f, 2, 3.3f), Rgb(0.07f, 1.3f, 3.3f), Rgb(0.7f, 1e-4f, 40));
    for (const Method& method : methods()) {
        const Layers smooth = method.smooth(now);
        EXPECT_TRUE(same_bits(smooth.direct.e_rv_virtual, now.direct.e_rv_virtual)) << method.name;
        EXPECT_TRUE(same_bits(smooth.s_rv, now.s_rv)) << method.name;
        EXPECT_TRUE(same_bits(smooth.m, now.m)) << method.name;
        EXPECT_TRUE(same_bits(smooth.k_v, now.k_v)) << method.name;
        if (!method.keeps_ratio) continue;
        EXPECT_TRUE(same_bits(smooth.direct, now.direct)) << method.name;
        EXPECT_TRUE(same_bits(smooth.indirect, now.indirect)) << method.name;
    }
}

TEST(Baselines, RatioOfConstantLightIsThatRatio) {
    NoisyLayers now = plane_and_ball(1);
    fill_light(now, Rgb(2), Rgb(1), Rgb(0));
    const Layers smooth = gaussian_ratio(now, 3);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        EXPECT_EQ(smooth.direct.e_r.pixels[i] + smooth.indirect.e_r.pixels[i], Rgb(1));
        const Rgb e = smooth.direct.e_rv_real.pixels[i] + smooth.indirect.e_rv_real.pixels[i];
        // (1 + epsilon) / (2 + epsilon) with epsilon 1e-3 of the mean
        EXPECT_NEAR(e.r, 0.5, 1e-3);
    }
}

TEST(Baselines, LeaveEqualModesEqualToTheBitBeyondTheReachOfAChange) {
    for (const Method& method : methods()) {
        NoisyLayers now = plane_and_ball(6);
        now.direct.e_rv_real = now.direct.e_r;
        now.indirect.e_rv_real = now.indirect.e_r;
        for (int y = 20; y < 24; ++y) {
            for (int x = 30; x < 35; ++x)
                now.direct.e_rv_real(x, y) *= 0.3f;
        }
        const Layers smooth = method.smooth(now);
        if (method.keeps_ratio) {
            EXPECT_TRUE(same_bits(smooth.indirect.e_r, smooth.indirect.e_rv_real)) << method.name;
        }
        for (int y = 0; y < 48; ++y) {
            for (int x = 0; x < 64; ++x) {
                const bool reached = x >= 30 - method.reach && x < 35 + method.reach &&
                                     y >= 20 - method.reach && y < 24 + method.reach;
                const bool equal = smooth.direct.e_r(x, y) == smooth.direct.e_rv_real(x, y);
                EXPECT_TRUE(reached || equal) << method.name << ' ' << x << ' ' << y;
            }
        }
        EXPECT_NE(smooth.direct.e_r(32, 22), smooth.direct.e_rv_real(32, 22)) << method.name;
    }
}

TEST(Baselines, GuidedFilterForgetsWhatLiesBeyondItsReach) {
    // A sum that adds what enters its window and takes away what leaves would keep the rounding
    // error of light this bright, 1e-16 of it, which is far above that of the light around.
    const NoisyLayers now = noisy_plane(96, 48, spacing, 8);
    NoisyLayers bright = now;
    for (int y = 20; y < 24; ++y) {
        for (int x = 30; x < 35; ++x)
            bright.direct.e_r(x, y) = Rgb(1e12f);
    }
    const Layers plain = guided_filter(now, 3), changed = guided_filter(bright, 3);
    for (int y = 0; y < 48; ++y) {
        for (int x = 0; x < 96; ++x) {
            const bool reached = x >= 24 && x < 41 && y >= 14 && y < 30;
            EXPECT_TRUE(reached || plain.direct.e_r(x, y) == changed.direct.e_r(x, y))
                << x << ' ' << y;
        }
    }
}

/// Variance of the red direct E_R, 12 px and more from the border.
double variance_within(const Image<Rgb>& image) {
    double sum = 0, squares = 0, count = 0;
    for (int y = 12; y < image.height - 12; ++y) {
        for (int x = 12; x < image.width - 12; ++x) {
            const double v = image(x, y).r;
            sum += v, squares += v * v, ++count;
        }
    }
    return squares / count - sum * sum / (count * count);
}

TEST(Baselines, LowerTheVarianceOfWhiteNoiseAsTheKernelSays) {
    const NoisyLayers now = noisy_plane(256, 256, spacing, 3);
    const double noise = variance_within(now.direct.e_r);
    const auto share = [&](const Layers& l) { return variance_within(l.direct.e_r) / noise; };
    // A Gaussian leaves 1 / (4 pi sigma^2). 54000 pixels hold 54000 / (4 pi sigma^2) independent
    // values of the result, so their variance is known to 3 % at sigma 2: 10 % is three of these.
    const double of_gaussian = 1 / (4 * M_PI * 4);
    EXPECT_NEAR(share(gaussian_irradiance(now, 2)) / of_gaussian, 1, 0.1);
    // Cut at 2 sigma the bilateral kernel keeps a little more.
    EXPECT_NEAR(share(joint_bilateral(now, 2)) / of_gaussian, 1.05, 0.15);
    // A plane's guide is constant: two box means of 7 x 7, the variance of a triangle kernel, in
    // which sum w^2 = (2 n^2 + 1) / (3 n^3) per axis, n = 7.
    const double of_triangle = (2 * 49 + 1) / (3.0 * 343);
    EXPECT_NEAR(share(guided_filter(now, 3)) / (of_triangle * of_triangle), 1, 0.1);
    // Edge stops on the noise itself keep more of it than their kernels, and lose most.
    EXPECT_LT(share(non_local_means(now, 1)), 0.2);
    EXPECT_LT(share(a_trous(now, 3)), 0.1);
}

/// Two half planes of equal depth along a vertical edge; the right one is as told.
NoisyLayers two_halves(const glm::vec3& right_normal, std::uint32_t right_object) {
    NoisyLayers now = noisy_plane(48, 32, spacing, 4);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 48; ++x) {
            now.direct.e_r(x, y) = now.direct.e_rv_real(x, y) = Rgb(x < 24 ? 1.0f : 3.0f);
            if (x < 24) continue;
            now.real.normal(x, y) = right_normal;
            now.real.object(x, y) = right_object;
        }
    }
    return now;
}

TEST(Baselines, GuidedOnesDoNotCrossEdgesOfNormals) {
    const NoisyLayers now = two_halves({1, 0, 0}, 1);
    for (const Method& method : methods()) {
        const Layers smooth = method.smooth(now);
        const double left = smooth.direct.e_r(23, 16).r, right = smooth.direct.e_r(24, 16).r;
        if (method.guided) {
            // epsilon 1e-3 against a variance of normals of 1/4 per axis leaves 0.4 % of the step
            EXPECT_NEAR(left, 1, 0.01) << method.name;
            EXPECT_NEAR(right, 3, 0.01) << method.name;
        } else if (!method.keeps_shadows && method.keeps_ratio) {
            EXPECT_GT(left, 1.3) << method.name;  // about a half of the kernel lies beyond
        }
    }
}

TEST(Baselines, ThoseWithWeightsPerPairDoNotCrossObjects) {
    const NoisyLayers now = two_halves({0, 0, 1}, 2);
    for (const Layers& smooth :
         {joint_bilateral(now, 3), non_local_means(now, 5), a_trous(now, 3)}) {
        EXPECT_TRUE(same_bits(smooth.direct.e_r, now.direct.e_r));
        EXPECT_TRUE(same_bits(smooth.direct.e_rv_real, now.direct.e_rv_real));
    }
}

TEST(Baselines, DoNotMixRealAndVirtualReceiversNorEmptyPixels) {
    NoisyLayers now = plane_and_ball(7);
    fill_light(now, Rgb(1), Rgb(0.5f), Rgb(9));
    for (int y = 0; y < 10; ++y) {
        for (int x = 0; x < 64; ++x)
            now.real.object(x, y) = 0;
    }
    for (const Method& method : methods()) {
        const Layers smooth = method.smooth(now);
        for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
            const Rgb on_virtual = now.virtual_.object.pixels[i] != 0 ? Rgb(9) : Rgb(0);
            EXPECT_EQ(smooth.direct.e_rv_virtual.pixels[i], on_virtual) << method.name;
            const Rgb e_r = now.real.object.pixels[i] != 0 ? Rgb(1) : Rgb(0);
            EXPECT_EQ(smooth.direct.e_r.pixels[i], e_r) << method.name;
        }
    }
}

TEST(Baselines, StayFiniteWhateverTheyAreGiven) {
    const float inf = std::numeric_limits<float>::infinity();
    for (const float bad : {std::nanf(""), inf, -inf, 3e38f, 1e30f, 1e-38f, 0.0f}) {
        NoisyLayers now = plane_and_ball(8);
        now.direct.e_r(10, 10) = now.direct.e_rv_real(12, 10) = Rgb(bad);
        now.indirect.e_rv_virtual(32, 24) = now.s_rv(32, 24) = Rgb(bad);
        now.real.normal(20, 20) = glm::vec3(bad);
        now.real.position(25, 20) = glm::vec3(bad);
        for (const Method& method : methods()) {
            const Layers smooth = method.smooth(now);
            for (const Irradiance* light : {&smooth.direct, &smooth.indirect}) {
                SCOPED_TRACE(method.name + " given " + std::to_string(bad));
                expect_sound(*light);
            }
            for (const Rgb& s : smooth.s_rv.pixels)
                EXPECT_TRUE(std::isfinite(s.r + s.g + s.b)) << method.name;
        }
    }
}

TEST(Baselines, WorkOnTheSmallestImages) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 3}}) {
        const NoisyLayers now = noisy_plane(width, height, spacing, 9);
        for (const Method& method : methods()) {
            const Layers smooth = method.smooth(now);
            SCOPED_TRACE(method.name);
            expect_sound(smooth.direct);
            if (width == 1 && height == 1 && method.keeps_ratio) {
                EXPECT_TRUE(same_bits(smooth.direct, now.direct));
            }
        }
    }
    for (const Method& method : methods())
        EXPECT_NO_THROW(method.smooth(layers_from_above(8, 8, spacing))) << method.name;
}

TEST(Baselines, GiveTheSameBytesForAnyNumberOfThreads) {
    const NoisyLayers now = plane_and_ball(10);
    for (const Method& method : methods()) {
        set_thread_count(1);
        const Layers alone = method.smooth(now);
        set_thread_count(3);
        const Layers together = method.smooth(now);
        set_thread_count(0);
        EXPECT_TRUE(same_bits(alone, together)) << method.name;
    }
}

TEST(Baselines, RefuseWidthsOutOfRange) {
    const NoisyLayers now = layers_from_above(4, 4, spacing);
    for (const double bad : {0.0, -1.0, std::nan(""), double(INFINITY)}) {
        EXPECT_THROW(gaussian_irradiance(now, bad), Error);
        EXPECT_THROW(gaussian_ratio(now, bad), Error);
        EXPECT_THROW(joint_bilateral(now, bad), Error);
        EXPECT_THROW(non_local_means(now, bad), Error);
        EXPECT_THROW(guided_filter(now, 3, bad), Error);
    }
    EXPECT_THROW(guided_filter(now, 0), Error);
    EXPECT_THROW(a_trous(now, 0), Error);
    EXPECT_THROW(a_trous(now, 6), Error);
    NoisyLayers misfit = now;
    misfit.real.normal = Image<glm::vec3>(3, 4);
    EXPECT_THROW(gaussian_irradiance(misfit, 1), Error);
}

}  // namespace
}  // namespace inlay::test
