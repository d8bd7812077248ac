// Warps and environments: directions come as often as their density says.
#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"
#include "render/sample/warp.h"
#include "tests/support/chi_square.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

namespace inlay::test {
namespace {

constexpr int samples = 200000;

/// Independent numbers: chi-square takes samples that know nothing of each other, so each key has
/// a pixel of its own.
glm::vec2 pair_of(int i) {
    const SampleKey key{11, 0, std::uint32_t(i), 0};
    return {uniform(key, 0), uniform(key, 1)};
}

TEST(SamplingChiSquare, RegularisedGammaHasItsKnownValues) {
    EXPECT_NEAR(regularised_upper_gamma(1, 2), std::exp(-2.0), 1e-12);
    EXPECT_NEAR(regularised_upper_gamma(0.5, 3), std::erfc(std::sqrt(3.0)), 1e-12);
    EXPECT_NEAR(regularised_upper_gamma(50, 50), 0.4812, 1e-4);
}

TEST(SamplingChiSquare, StudentsTHasItsKnownValues) {
    EXPECT_NEAR(regularised_beta(0.5, 1, 1), 0.5, 1e-12);
    EXPECT_NEAR(regularised_beta(1 / (1 + 1.0), 0.5, 0.5), 0.5, 1e-12);  // t = 1, one freedom
    const RunningMean m = mean_of(std::vector<double>{1, 2, 3, 4, 5});
    EXPECT_NEAR(mean_p_value(m, 1), 0.04742, 1e-4);  // t = 2.828, four degrees of freedom
}

TEST(SamplingChiSquare, TheTestSeesADensityThatIsWrong) {
    const double p = sampling_p_value(
        DirectionGrid{}, samples,
        [](int i) { return glm::dvec3(sample_cosine_hemisphere(pair_of(i)).direction); },
        [](const glm::dvec3& d) { return double(pdf_cosine_power(d, 1.05f)); });
    EXPECT_LT(p, 1e-6);
}

TEST(SamplingChiSquare, CosineHemisphere) {
    EXPECT_TRUE(plausible(sampling_p_value(
        DirectionGrid{}, samples,
        [](int i) { return glm::dvec3(sample_cosine_hemisphere(pair_of(i)).direction); },
        [](const glm::dvec3& d) { return double(pdf_cosine_hemisphere(d)); })));
}

TEST(SamplingChiSquare, StratifiedPairsAreUniformOverPixels) {
    EXPECT_TRUE(plausible(sampling_p_value(
        DirectionGrid{}, samples,
        [](int i) {
            const SampleKey key{11, 5, std::uint32_t(i), 9};
            return glm::dvec3(sample_cosine_hemisphere(stratified_pair(key, 2)).direction);
        },
        [](const glm::dvec3& d) { return double(pdf_cosine_hemisphere(d)); })));
}

class CosinePower : public ::testing::TestWithParam<float> {};

TEST_P(CosinePower, FollowsItsDensity) {
    const float n = GetParam();
    const DirectionGrid grid{16, 32, n > 100 ? 1 - 10 / double(n) : n > 10 ? 0.5 : -1};
    EXPECT_TRUE(plausible(sampling_p_value(
        grid, samples,
        [n](int i) { return glm::dvec3(sample_cosine_power(pair_of(i), n).direction); },
        [n](const glm::dvec3& d) { return double(pdf_cosine_power(d, n)); })));
}

INSTANTIATE_TEST_SUITE_P(Exponents, CosinePower,
                         ::testing::Values(0.0f, 1.0f, 5.0f, 64.0f, 1000.0f, 10000.0f));

/// Counts in quarters of texels, since a density that jumps between texels needs cells that do.
double environment_p_value(const Image<Rgb>& map) {
    const EnvironmentSampler sampler = environment_of(map);
    const int columns = 2 * map.width, rows = 2 * map.height;
    const Image<Rgb> cells(columns, rows);  // for the solid angles of quarters
    std::vector<double> counts(std::size_t(columns) * std::size_t(rows), 0.0);
    for (int i = 0; i < samples; ++i) {
        const LightSample s = sample_environment(sampler, pair_of(i));
        const glm::dvec2 at = texel_from_direction(cells, glm::dvec3(s.direction));
        counts[cells.index(std::min(int(at.x), columns - 1), std::min(int(at.y), rows - 1))] += 1;
    }
    std::vector<double> expected;
    for (int y = 0; y < rows; ++y) {
        for (int x = 0; x < columns; ++x) {
            const glm::vec3 d(direction_from_texel(cells, {x + 0.5, y + 0.5}));
            expected.push_back(samples * double(pdf_environment(sampler, d)) *
                               texel_solid_angle(cells, y));
        }
    }
    return chi_square_p_value(counts, expected);
}

TEST(EnvironmentChiSquare, Lobe) {
    const glm::dvec3 axis = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
    EXPECT_TRUE(plausible(environment_p_value(lobe_map(axis, 10, 0.1f, Rgb(3, 2, 1)))));
    EXPECT_TRUE(plausible(environment_p_value(lobe_map({0, -1, 0}, 40, 0.0f, Rgb(3)))));
}

TEST(EnvironmentChiSquare, OneHotPixel) {
    EXPECT_TRUE(plausible(environment_p_value(hot_pixel_map(9, 4, 5e4f, 0.5f))));
    EXPECT_TRUE(plausible(environment_p_value(hot_pixel_map(3, 0, 5e4f, 0.5f))));  // at the pole
    EXPECT_TRUE(plausible(environment_p_value(hot_pixel_map(31, 15, 100, 0.5f))));
}

TEST(EnvironmentChiSquare, Black) {
    EXPECT_TRUE(plausible(environment_p_value(Image<Rgb>(12, 6, Rgb(0)))));
}

}  // namespace
}  // namespace inlay::test
