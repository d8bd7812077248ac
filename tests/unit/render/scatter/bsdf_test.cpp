// Bsdf: materials at a point, energy of the Phong lobe, textures, and the frame they stand in.
#include "render/scatter/bsdf.h"

#include "recordings/base/random.h"
#include "tests/support/chi_square.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/matchers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace inlay::test {
namespace {

glm::vec3 towards(double theta_deg) {
    const double theta = theta_deg * std::numbers::pi / 180;
    return {std::sin(theta), 0, std::cos(theta)};
}

double glossy_albedo(const Bsdf& bsdf, const glm::vec3& viewer) {
    const ScatterFrame frame = scatter_frame({0, 0, 1}, viewer);
    const DirectionGrid grid{16, 16, 0};
    double sum = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell)
        sum += grid.integral(
            cell, [&](const glm::dvec3& l) { return double(eval_glossy(bsdf, frame, l).r); });
    return sum;
}

TEST(Phong, ReflectsAllOfItsSpecularShareAlongTheNormalAndNeverMore) {
    for (const float n : {1.0f, 8.0f, 64.0f}) {
        const Bsdf bsdf = bsdf_at(Phong{Rgb(0), Rgb(1), n}, {0, 0}, 1);
        // 1e-3: the quadrature
        EXPECT_NEAR(glossy_albedo(bsdf, towards(0)), 1, 1e-3) << "n = " << n;
        for (const double theta : {20.0, 45.0, 70.0, 85.0})
            EXPECT_LE(glossy_albedo(bsdf, towards(theta)), 1.001) << "n = " << n;
    }
}

TEST(Phong, JacobianOfTheSamplerIsItsDensity) {
    const Bsdf bsdf = bsdf_at(Phong{Rgb(0), Rgb(1), 20}, {0, 0}, 1);
    const ScatterFrame frame = scatter_frame({0, 0, 1}, towards(40));
    const auto warp = [&](glm::vec2 u) {
        return glm::dvec3(sample_glossy(bsdf, frame, u).direction);
    };
    for (const glm::vec2 u : {glm::vec2(0.1f, 0.2f), {0.5f, 0.5f}, {0.8f, 0.3f}}) {
        const DirectionSample s = sample_glossy(bsdf, frame, u);
        EXPECT_NEAR(density_from_jacobian(warp, u, 1e-3f) / s.pdf, 1, 5e-3);
        // 1e-4: the exponent times the rounding of the cosine to the mirror direction
        EXPECT_NEAR(pdf_glossy(bsdf, frame, s.direction) / s.pdf, 1, 1e-4);
    }
}

TEST(Bsdf, NothingIsReflectedOrSampledBelowTheSurface) {
    for (const Material& material :
         {Material(Phong{Rgb(0), Rgb(1), 4}), Material(Ggx{Rgb(1), glm::vec2(0.9f), 1, nullptr})}) {
        const Bsdf bsdf = bsdf_at(material, {0, 0}, 1);
        const ScatterFrame frame = scatter_frame({0, 0, 1}, towards(80));
        const glm::vec3 below{-std::sqrt(1 - 0.01f), 0, -0.1f};
        EXPECT_EQ(eval_glossy(bsdf, frame, below), Rgb(0));
        EXPECT_EQ(pdf_glossy(bsdf, frame, below), 0);
        int lost = 0;
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const DirectionSample s = sample_glossy(bsdf, frame, stratified_pair({1, 0, 0, i}, 0));
            EXPECT_EQ(s.pdf > 0, s.direction.z > 0);
            lost += s.pdf == 0;
        }
        EXPECT_GT(lost, 0);  // at 80 degrees part of both lobes lies below
    }
}

TEST(Bsdf, RoughnessIsTheRootOfAlphaAndAMetalHasNoBase) {
    const Bsdf bsdf = bsdf_at(Ggx{Rgb(1), glm::vec2(std::sqrt(0.5f)), 1, nullptr}, {0, 0}, 1);
    EXPECT_EQ(bsdf.diffuse, Rgb(0));
    // alpha = 1/2 at 60 degrees, F = 1; 1e-3: the quadrature
    EXPECT_NEAR(glossy_albedo(bsdf, towards(60)), 0.69825, 1e-3);
}

TEST(Bsdf, WhitePlasticNeverReflectsMoreThanItGets) {
    for (const float roughness : {0.3f, 0.5f, 0.8f, 1.0f}) {
        for (const double theta : {0.0, 30.0, 60.0, 75.0, 85.0}) {
            const Bsdf bsdf =
                bsdf_at(Ggx{Rgb(1), glm::vec2(roughness), 0, nullptr}, {0, 0}, towards(theta).z);
            EXPECT_LE(bsdf.diffuse.r + glossy_albedo(bsdf, towards(theta)), 1.001)
                << "roughness " << roughness << " at " << theta << " degrees";
        }
    }
}

TEST(Bsdf, TheFrameStandsOnTheViewersSide) {
    for (const glm::vec3& normal : {glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)})
        EXPECT_EQ(scatter_frame(normal, towards(30)).world_from_local[2], glm::vec3(0, 0, 1));
}

TEST(Bsdf, TexturesMultiplyTheDiffusePartAndRepeat) {
    Texture image(2, 1);
    image(0, 0) = Rgb(1, 0, 0);
    image(1, 0) = Rgb(0, 1, 0);
    const auto texture = std::make_shared<const Texture>(image);
    const Diffuse material{Rgb(0.5f), texture};
    const auto at = [&](float u) { return bsdf_at(material, {u, 0.5f}, 1).diffuse; };
    EXPECT_TRUE(near(at(0.25f), {0.5, 0, 0}, 1e-6));
    EXPECT_TRUE(near(at(0.5f), {0.25, 0.25, 0}, 1e-6));  // bilinear between the texels' centres
    EXPECT_TRUE(near(at(1.25f), at(0.25f), 1e-6));
    EXPECT_TRUE(near(at(-0.75f), at(0.25f), 1e-6));
}

TEST(Bsdf, TextureCoordinatesOfAnySizeAreHarmless) {
    const auto texture = std::make_shared<const Texture>(Texture(4096, 4096, Rgb(0.25f)));
    const auto at = [&](float u) { return bsdf_at(Diffuse{Rgb(1), texture}, {u, u}, 1).diffuse; };
    EXPECT_EQ(at(NAN), Rgb(0.25f));
    const FloatingPointTraps traps;  // a comparison with NaN would count as invalid
    for (const float u : {9e5f, -9e5f, 1e9f, 1e30f, INFINITY, -0.0f, 1.0f})
        EXPECT_EQ(at(u), Rgb(0.25f)) << u;
}

TEST(Bsdf, BandwidthGrowsWithTheRootOfTheExponent) {
    EXPECT_EQ(glossy_bandwidth(bsdf_at(Diffuse{}, {0, 0}, 1)), 0);
    EXPECT_NEAR(glossy_bandwidth(bsdf_at(Phong{Rgb(0), Rgb(1), 64}, {0, 0}, 1)), 14.6, 0.05);
    const float smooth =
        glossy_bandwidth(bsdf_at(Ggx{Rgb(1), glm::vec2(0.2f), 1, nullptr}, {0, 0}, 1));
    const float rough =
        glossy_bandwidth(bsdf_at(Ggx{Rgb(1), glm::vec2(0.8f), 1, nullptr}, {0, 0}, 1));
    EXPECT_GT(smooth, 4 * rough);  // alpha is roughness squared: a factor 16 in alpha
}

}  // namespace
}  // namespace inlay::test
