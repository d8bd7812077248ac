// GGX: directional albedo against values by quadrature, reciprocity, Jacobian, hard cases.
#include "render/scatter/ggx.h"

#include "recordings/base/random.h"
#include "tests/support/chi_square.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/matchers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay::test {
namespace {

glm::vec3 direction(double theta_deg, double phi_deg) {
    const double theta = theta_deg * std::numbers::pi / 180, phi = phi_deg * std::numbers::pi / 180;
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

struct AlbedoCase {
    glm::vec2 alpha;
    double theta_deg, phi_deg, albedo;
};

class GgxAlbedo : public ::testing::TestWithParam<AlbedoCase> {};

/// Integral of f cos over the directions above, with F = 1: weights of visible normals on a regular
/// grid of the unit square. The weight G2 / G1 lies within 0..1 and is smooth but for the horizon.
double directional_albedo(glm::vec2 alpha, const glm::vec3& viewer, int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const glm::vec2 u{(float(i) + 0.5f) / float(steps), (float(j) + 0.5f) / float(steps)};
            const DirectionSample s = sample_ggx(alpha, viewer, u);
            if (s.pdf > 0) sum += eval_ggx(Rgb(1), alpha, viewer, s.direction).r / s.pdf;
        }
    }
    return sum / (double(steps) * steps);
}

TEST_P(GgxAlbedo, AgreesWithQuadrature) {
    const AlbedoCase c = GetParam();
    // 2e-4: the horizon cuts about `steps` of the grid's cells in two
    EXPECT_NEAR(directional_albedo(c.alpha, direction(c.theta_deg, c.phi_deg), 1000), c.albedo,
                2e-4);
}

INSTANTIATE_TEST_SUITE_P(Golden, GgxAlbedo,
                         ::testing::Values(AlbedoCase{{0.1f, 0.1f}, 0, 0, 0.98831},
                                           AlbedoCase{{0.5f, 0.5f}, 60, 0, 0.69825},
                                           AlbedoCase{{1, 1}, 80, 0, 0.66819},
                                           AlbedoCase{{1, 0.1f}, 80, 0, 0.80350},
                                           AlbedoCase{{1, 0.1f}, 80, 90, 0.51549},
                                           AlbedoCase{{0.25f, 0.05f}, 45, 30, 0.93099}));

/// The same integral over a grid of light directions, which knows nothing of the sampler.
TEST(Ggx, AlbedoBySamplingIsTheIntegralOfItsValue) {
    const glm::vec2 alpha{0.5f, 0.3f};
    const glm::vec3 viewer = direction(50, 20);
    const DirectionGrid grid{16, 16, 0};
    double integral = 0;
    for (std::size_t cell = 0; cell < grid.size(); ++cell)
        integral += grid.integral(cell, [&](const glm::dvec3& l) {
            return double(eval_ggx(Rgb(1), alpha, viewer, l).r);
        });
    // 5e-4: the quadrature, and the grid in the unit square as above
    EXPECT_NEAR(directional_albedo(alpha, viewer, 500), integral, 5e-4);
}

TEST(Ggx, IsReciprocal) {
    for (const glm::vec2 alpha : {glm::vec2(0.05f), glm::vec2(0.5f), glm::vec2(1, 0.1f)}) {
        for (std::uint32_t i = 0; i < 500; ++i) {
            const glm::vec3 a =
                sample_cosine_hemisphere(stratified_pair({1, 0, 0, i}, 0)).direction;
            const glm::vec3 b =
                sample_cosine_hemisphere(stratified_pair({1, 0, 0, i}, 1)).direction;
            // value times cosine, so that f(a, b) = f(b, a) reads value(a, b) a.z = value(b, a) b.z
            const double there = eval_ggx(Rgb(0.3f), alpha, a, b).r * a.z;
            const double back = eval_ggx(Rgb(0.3f), alpha, b, a).r * b.z;
            EXPECT_NEAR(there, back, 1e-4 * std::max(there, back));  // float half vectors
        }
    }
}

TEST(Ggx, SwappingTheRoughnessesTurnsTheLobe) {
    const auto swapped = [](const glm::vec3& w) { return glm::vec3(w.y, w.x, w.z); };
    const glm::vec3 viewer = direction(40, 25), light = direction(55, 160);
    EXPECT_FLOAT_EQ(eval_ggx(Rgb(1), {0.4f, 0.1f}, viewer, light).r,
                    eval_ggx(Rgb(1), {0.1f, 0.4f}, swapped(viewer), swapped(light)).r);
}

TEST(Ggx, JacobianOfTheSamplerIsItsDensity) {
    for (const glm::vec2 alpha : {glm::vec2(0.1f), glm::vec2(0.6f), glm::vec2(0.8f, 0.2f)}) {
        for (const double theta : {0.0, 30.0, 70.0}) {
            const glm::vec3 viewer = direction(theta, 40);
            const auto warp = [&](glm::vec2 u) {
                return glm::dvec3(sample_ggx(alpha, viewer, u).direction);
            };
            for (const glm::vec2 u : {glm::vec2(0.2f, 0.1f), {0.5f, 0.6f}, {0.7f, 0.9f}}) {
                const DirectionSample s = sample_ggx(alpha, viewer, u);
                if (!(s.pdf > 0)) continue;
                // 1 %: rounding over the step, and float half vectors in narrow lobes
                EXPECT_NEAR(density_from_jacobian(warp, u, 1e-3f) / s.pdf, 1, 1e-2);
            }
        }
    }
}

TEST(Ggx, HardCasesAreFiniteAndRaiseNothing) {
    const FloatingPointTraps traps;
    for (const float ax : {1e-3f, 0.1f, 1.0f}) {
        for (const float ay : {1e-3f, 1.0f}) {
            for (const double theta : {0.0, 45.0, 89.99, 89.9999, 90.0, 120.0}) {
                for (const double phi : {-0.0, 90.0, 180.0, 360.0}) {
                    const glm::vec3 viewer = direction(theta, phi);
                    for (std::uint32_t i = 0; i < 64; ++i) {
                        const glm::vec2 u = stratified_pair({1, 0, 0, i}, 0);
                        const DirectionSample s = sample_ggx({ax, ay}, viewer, u);
                        EXPECT_TRUE(sound(s.pdf));
                        EXPECT_NEAR(glm::length(s.direction), 1, 1e-4);
                        EXPECT_TRUE(sound(eval_ggx(Rgb(0.04f), {ax, ay}, viewer, s.direction)));
                        if (s.pdf > 0) {  // the weight of a sample never exceeds 1
                            EXPECT_LE(eval_ggx(Rgb(1), {ax, ay}, viewer, s.direction).r / s.pdf,
                                      1.001f);
                        }
                    }
                }
            }
        }
    }
}

TEST(Ggx, OppositeDirectionsAtTheHorizonAreFinite) {
    for (const float z : {1e-6f, 1e-20f, 1e-30f}) {
        const glm::vec3 viewer{1, 0, z}, light{-1, 0, z};
        EXPECT_TRUE(sound(eval_ggx(Rgb(1), glm::vec2(0.5f), viewer, light)));
        EXPECT_TRUE(sound(pdf_ggx(glm::vec2(0.5f), viewer, light)));
    }
}

}  // namespace
}  // namespace inlay::test
