// EnvironmentSampler: density, radiance and refusals, on maps whose answers are known.
#include "render/sample/environment_sampler.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "tests/support/chi_square.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace inlay::test {
namespace {

const glm::dvec3 lobe_axis = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));

TEST(EnvironmentSampler, AConstantMapIsSampledEvenly) {
    const EnvironmentSampler sampler = constant_environment(3);
    EXPECT_NEAR(sampler.mean_luminance, 3, 1e-5);
    for (std::uint32_t i = 0; i < 200; ++i) {
        const LightSample s = sample_environment(sampler, stratified_pair({1, 0, 0, i}, 0));
        EXPECT_NEAR(s.pdf, 1 / (4 * std::numbers::pi), 1e-7);
        EXPECT_EQ(s.radiance, Rgb(3));
        EXPECT_NEAR(glm::length(s.direction), 1, 1e-6);
    }
}

/// What a direction tells is what drawing it told, but where rounding moves it to the next texel.
TEST(EnvironmentSampler, AlongADirectionLiesTheSampleThatWasDrawn) {
    const EnvironmentSampler sampler = environment_of(lobe_map(lobe_axis, 5, 0.2f, Rgb(3, 2, 1)));
    int same = 0;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const LightSample drawn = sample_environment(sampler, stratified_pair({1, 0, 0, i}, 0));
        const LightSample along = sample_along(sampler, drawn.direction);
        EXPECT_EQ(along.direction, drawn.direction);
        EXPECT_EQ(along.pdf, pdf_environment(sampler, drawn.direction));
        same += along.radiance == drawn.radiance && std::abs(along.pdf / drawn.pdf - 1) < 1e-5f;
    }
    EXPECT_GE(same, 995);
}

TEST(EnvironmentSampler, JacobianIsTheDensity) {
    for (const Image<Rgb>& map :
         {lobe_map(lobe_axis, 5, 0.2f, Rgb(3, 2, 1)), hot_pixel_map(9, 4, 5e4f)}) {
        const EnvironmentSampler sampler = environment_of(map);
        const auto warp = [&](glm::vec2 u) {
            return glm::dvec3(sample_environment(sampler, u).direction);
        };
        constexpr float step = 1e-4f;
        int tested = 0;
        for (std::uint32_t i = 0; i < 40; ++i) {
            const glm::vec2 u = stratified_pair({3, 0, 0, i}, 0);
            const LightSample s = sample_environment(sampler, u);
            bool same_texel = true;  // the warp jumps between texels
            for (const glm::vec2 o : {glm::vec2(step, 0), {-step, 0}, {0, step}, {0, -step}}) {
                const LightSample beside = sample_environment(sampler, u + o);
                same_texel = same_texel && beside.pdf == s.pdf && beside.radiance == s.radiance;
            }
            if (!same_texel) continue;
            ++tested;
            // 1 %: float directions carry 6e-8, a step moves them by about 1e-4 x texel / share
            EXPECT_NEAR(density_from_jacobian(warp, u, step) / s.pdf, 1, 1e-2);
        }
        EXPECT_GT(tested, 20);
    }
}

TEST(EnvironmentSampler, DensityAndRadianceAgreeWithTheMapInEveryDirection) {
    EnvironmentMap map{lobe_map(lobe_axis, 20, 0.1f, Rgb(5)), glm::dmat3(1.0)};
    map.world_from_environment = look_at({0, 0, 0}, {0.2, 0.9, 0.4}, {1, 0, 0}).rotation;
    const EnvironmentSampler sampler = make_environment_sampler(map);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const LightSample s = sample_environment(sampler, stratified_pair({1, 0, 0, i}, 0));
        const Rgb seen = radiance_from(map, s.direction);
        const float pdf = pdf_environment(sampler, s.direction);
        // radiance / pdf is constant times luminance over rows: both sides see one texel, or its
        // neighbour where a float direction lies on the edge; neighbours differ by at most 50 %.
        EXPECT_NEAR(luminance(seen) / luminance(s.radiance), 1, 0.6);
        EXPECT_NEAR(luminance(seen) / pdf, luminance(s.radiance) / s.pdf,
                    1e-4 * luminance(s.radiance) / s.pdf);
    }
}

TEST(EnvironmentSampler, DensityIntegratesToOne) {
    for (const Image<Rgb>& map :
         {lobe_map(lobe_axis, 50, 0.0f, Rgb(9)), hot_pixel_map(0, 0, 5e4f, 0.1f),
          hot_pixel_map(31, 15, 5e4f), Image<Rgb>(7, 3, Rgb(0)), Image<Rgb>(1, 1, Rgb(2))}) {
        const EnvironmentSampler sampler = environment_of(map);
        double integral = 0;
        for (int y = 0; y < map.height; ++y) {
            for (int x = 0; x < map.width; ++x) {
                const glm::vec3 d(direction_from_texel(map, {x + 0.5, y + 0.5}));
                integral += pdf_environment(sampler, d) * texel_solid_angle(map, y);
            }
        }
        EXPECT_NEAR(integral, 1, 1e-6);
    }
}

TEST(EnvironmentSampler, ABlackMapIsSampledEvenlyAndIsBlack) {
    const EnvironmentSampler sampler = constant_environment(0);
    EXPECT_EQ(sampler.mean_luminance, 0);
    const LightSample s = sample_environment(sampler, {0.3f, 0.7f});
    EXPECT_NEAR(s.pdf, 1 / (4 * std::numbers::pi), 1e-7);
    EXPECT_EQ(s.radiance, Rgb(0));
}

TEST(EnvironmentSampler, MeanLuminanceWeighsRowsBySolidAngle) {
    EXPECT_NEAR(half_environment(1, 0).mean_luminance, 0.5, 1e-6);
    const Image<Rgb> map = hot_pixel_map(5, 0, 5e4f);
    const double expected = 5e4 * texel_solid_angle(map, 0) / (4 * std::numbers::pi);
    EXPECT_NEAR(environment_of(map).mean_luminance / expected, 1, 1e-5);
}

TEST(EnvironmentSampler, RefusesTexelsThatAreNoRadianceAndNamesTheirPlace) {
    for (const float bad : {NAN, INFINITY, -1.0f}) {
        Image<Rgb> map(8, 4, Rgb(1));
        map(5, 2).g = bad;
        try {
            environment_of(map);
            FAIL() << "accepted " << bad;
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ExitCode::bad_data);
            EXPECT_THAT(e.what(), ::testing::HasSubstr("(5, 2)"));
        }
    }
    EXPECT_THROW(environment_of({}), Error);
}

}  // namespace
}  // namespace inlay::test
