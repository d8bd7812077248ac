// Warps: the inverse undoes the sample, and the Jacobian is the density.
#include "render/sample/warp.h"

#include "recordings/base/random.h"
#include "tests/support/chi_square.h"
#include "tests/support/matchers.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace inlay::test {
namespace {

constexpr float exponents[] = {0, 1, 10, 64, 1000};

std::vector<glm::vec2> inner_points() {
    std::vector<glm::vec2> points;
    for (const float x : {0.05f, 0.3f, 0.6f, 0.9f})
        for (const float y : {0.1f, 0.45f, 0.8f})
            points.emplace_back(x, y);
    return points;
}

TEST(Warp, CosineHemisphereIsUndoneByItsInverse) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const glm::vec2 u{uniform({1, 0, 0, i}, 0), uniform({1, 0, 0, i}, 1)};
        const glm::vec2 back = invert_cosine_hemisphere(sample_cosine_hemisphere(u).direction);
        EXPECT_NEAR(back.x, u.x, 1e-6);  // float rounding of cos, sin and a square
        EXPECT_NEAR(back.y, u.y, 1e-6);
    }
}

TEST(Warp, CosinePowerIsUndoneByItsInverse) {
    for (const float n : exponents) {
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const glm::vec2 u{uniform({1, 0, 0, i}, 0), uniform({1, 0, 0, i}, 1)};
            const glm::vec2 back = invert_cosine_power(sample_cosine_power(u, n).direction, n);
            // The cosine's own rounding, 6e-8, is raised to the power n + 1.
            EXPECT_NEAR(back.x, u.x, 2e-6 + 1.2e-7 * n) << "n = " << n;
            // The azimuth is lost where the lobe's axis is closer than float resolves.
            if (u.x > 1e-2f) {
                EXPECT_NEAR(back.y, u.y, 2e-6) << "n = " << n;
            }
        }
    }
}

TEST(Warp, JacobianOfTheCosineHemisphereIsItsDensity) {
    const auto warp = [](glm::vec2 v) { return glm::dvec3(sample_cosine_hemisphere(v).direction); };
    for (const glm::vec2 u : inner_points()) {
        const DirectionSample s = sample_cosine_hemisphere(u);
        // 0.1 %: rounding of 6e-8 over a step of 1e-3, and the step's own third-order error
        EXPECT_NEAR(density_from_jacobian(warp, u, 1e-3f) / s.pdf, 1, 1e-3);
        EXPECT_FLOAT_EQ(s.pdf, pdf_cosine_hemisphere(s.direction));
    }
}

TEST(Warp, JacobianOfTheCosinePowerIsItsDensity) {
    for (const float n : exponents) {
        const auto warp = [n](glm::vec2 v) {
            return glm::dvec3(sample_cosine_power(v, n).direction);
        };
        for (const glm::vec2 u : inner_points()) {
            const DirectionSample s = sample_cosine_power(u, n);
            // 0.5 %: for n = 1000 the cosine is within 1e-3 of 1, where a float has 14 bits left
            EXPECT_NEAR(density_from_jacobian(warp, u, 4e-3f) / s.pdf, 1, 5e-3) << "n = " << n;
            // n roundings of the cosine
            EXPECT_NEAR(pdf_cosine_power(s.direction, n) / s.pdf, 1, 1e-6 + 1.2e-7 * n);
        }
    }
}

TEST(Warp, DirectionsAreUnitAndAboveTheHorizon) {
    const float last = std::nextafter(1.0f, 0.0f);
    for (const float x : {0.0f, 0x1p-24f, 0.5f, last}) {
        for (const float y : {0.0f, 0.25f, 0.5f, last}) {
            const DirectionSample cosine = sample_cosine_hemisphere({x, y});
            EXPECT_NEAR(glm::length(cosine.direction), 1, 1e-6);
            EXPECT_GT(cosine.direction.z, 0);
            EXPECT_GT(cosine.pdf, 0);
            for (const float n : exponents) {
                const DirectionSample power = sample_cosine_power({x, y}, n);
                EXPECT_NEAR(glm::length(power.direction), 1, 1e-6);
                EXPECT_GT(power.direction.z, 0);
                EXPECT_TRUE(sound(power.pdf));
            }
        }
    }
}

TEST(Warp, BasisIsARotationForEveryAxis) {
    std::vector<glm::vec3> axes = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, 1, -0.0f}, {0, 1, 0.0f}};
    for (std::uint32_t i = 0; i < 1000; ++i) {
        const float z = 2 * uniform({1, 0, 1, i}, 0) - 1, r = std::sqrt(1 - z * z);
        const float angle = 2 * std::numbers::pi_v<float> * uniform({1, 0, 1, i}, 1);
        axes.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    axes.push_back(glm::normalize(glm::vec3(1e-4f, -1e-4f, -1)));  // next to the seam at -z
    for (const glm::vec3& z : axes) {
        const glm::mat3 b = basis_about(z);
        EXPECT_EQ(b[2], z);
        EXPECT_TRUE(near(glm::transpose(b) * b * glm::vec3(1, 2, 3), {1, 2, 3}, 1e-5));
        EXPECT_NEAR(glm::determinant(b), 1, 1e-5);
    }
}

}  // namespace
}  // namespace inlay::test
