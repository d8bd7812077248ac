// Change cones: every direction in which a bounding sphere can be seen, with its density.
#include "render/trace/change_cones.h"

#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace inlay::test {
namespace {

const glm::vec3 up(0, 1, 0);

ChangeCones cones_of(const std::vector<BoundingSphere>& spheres) {
    ChangeCones cones;
    find_cones(spheres, glm::vec3(0), up, 0, cones);
    return cones;
}

/// The cases at which bounds are hard: apart, overlapping, touching the point, holding it, cut by
/// the horizon, tiny, huge.
std::vector<std::vector<BoundingSphere>> hard_bounds() {
    std::vector<BoundingSphere> crowd;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const SampleKey key{1, 0, i, 0};
        crowd.push_back({{uniform(key, 0) - 0.5f, 0.3f + uniform(key, 1), uniform(key, 2) - 0.5f},
                         0.3f * uniform(key, 3)});
    }
    crowd.resize(most_change_cones);
    return {{{{0, 2, 0}, 1}},
            {{{0, 2, 0}, 1}, {{0.5f, 2, 0}, 1}},
            {{{0, 1, 0}, 1}},
            {{{0, 0.5f, 0}, 1}},
            {{{0, 0.5f, 0}, 1}, {{0.2f, 0.1f, 0}, 1}, {{3, 0.5f, 0}, 1}},
            {{{3, 0.2f, 0}, 1}},
            {{{3, -0.9f, 0}, 1}},
            {{{0, 100, 0}, 1e-3f}, {{0, 50, 80}, 1e-2f}},
            {{{0, 1e4f, 0}, 9e3f}},
            crowd};
}

TEST(ChangeCones, DirectionsTowardsTheSpheresAboveTheHorizonAllHaveADensity) {
    for (const auto& spheres : hard_bounds()) {
        const ChangeCones cones = cones_of(spheres);
        for (std::uint32_t i = 0; i < 2000; ++i) {
            const SampleKey key{2, 0, i, 0};
            const BoundingSphere& s = spheres[i % spheres.size()];
            const glm::vec3 offset =
                glm::vec3(uniform(key, 0), uniform(key, 1), uniform(key, 2)) * 2.0f - 1.0f;
            if (glm::dot(offset, offset) > 1) continue;
            const glm::vec3 point = s.centre + s.radius * offset;
            if (!(point.y > 0)) continue;
            EXPECT_GT(pdf_cones(cones, glm::normalize(point)), 0) << glm::length(s.centre);
            EXPECT_TRUE(may_hold(cones, glm::normalize(point))) << glm::length(s.centre);
        }
    }
}

/// Directions from points about the one that the cones belong to, towards what lies above theirs.
TEST(ChangeCones, HoldWhatEveryPointWithinReachSees) {
    for (const auto& spheres : hard_bounds()) {
        for (const float reach : {1e-3f, 0.05f, 0.5f}) {
            ChangeCones cones;
            find_cones(spheres, glm::vec3(0), up, reach, cones);
            for (std::uint32_t i = 0; i < 2000; ++i) {
                const SampleKey key{4, 0, i, 0};
                const BoundingSphere& s = spheres[i % spheres.size()];
                const auto in_ball = [&](std::uint32_t dimension) {
                    return glm::vec3(uniform(key, dimension), uniform(key, dimension + 1),
                                     uniform(key, dimension + 2)) *
                               2.0f -
                           1.0f;
                };
                glm::vec3 offset = in_ball(0), step = in_ball(3);
                if (i % 2 == 0) {  // on the rim of what the farthest point sees
                    offset = glm::normalize(offset);
                    step = -offset;
                }
                if (glm::dot(offset, offset) > 1.0001f || glm::dot(step, step) > 1.0001f) continue;
                const glm::vec3 way = s.centre + s.radius * offset - reach * step;
                if (!(way.y > 0)) continue;
                EXPECT_GT(pdf_cones(cones, glm::normalize(way)), 0) << reach;
                EXPECT_TRUE(may_hold(cones, glm::normalize(way))) << reach;
            }
        }
    }
}

/// A direction on the rim of every cone, all around: also where two cones nearly share their axis,
/// so that the one that holds both is hardly larger.
TEST(ChangeCones, TheConeAboutAllHoldsTheirRims) {
    std::vector<std::vector<BoundingSphere>> cases = hard_bounds();
    for (const float apart : {0.0f, 1e-5f, 1e-4f, 1e-3f, 1e-2f})
        for (const float radius : {1e-3f, 0.1f, 0.9f})
            cases.push_back({{{0, 1, 0}, radius}, {{apart, 1, 0}, 0.99f * radius}});
    for (const auto& spheres : cases) {
        const ChangeCones cones = cones_of(spheres);
        for (std::size_t i = 0; i < std::size_t(cones.count); ++i) {
            const glm::mat3 basis =
                basis_about({cones.axis_x[i], cones.axis_y[i], cones.axis_z[i]});
            const float down = cones.height[i], sine = std::sqrt(down * (2 - down));
            for (int turn = 0; turn < 64; ++turn) {
                const float around = 0.1f * float(turn);
                const glm::vec3 rim{sine * std::cos(around), sine * std::sin(around), 1 - down};
                EXPECT_TRUE(may_hold(cones, glm::normalize(basis * rim)));
            }
        }
    }
}

/// An even sky's solid angle is 4 pi: the mean of density over even directions is 1 / (4 pi). 1e6
/// even directions of a spiral (Fibonacci) hit a cone's rim to 1e-3 of the sphere.
TEST(ChangeCones, DensitiesIntegrateToOne) {
    constexpr int directions = 1000000;
    for (const auto& spheres : hard_bounds()) {
        const ChangeCones cones = cones_of(spheres);
        const float widest =
            *std::max_element(cones.height.begin(), cones.height.begin() + cones.count);
        if (widest < 1e-3f) continue;  // too narrow for the spiral
        double sum = 0;
        for (int i = 0; i < directions; ++i) {
            const double y = 1 - 2 * (i + 0.5) / directions;
            const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
            const double r = std::sqrt(1 - y * y);
            sum += pdf_cones(cones, glm::vec3(r * std::cos(turn), y, r * std::sin(turn)));
        }
        EXPECT_NEAR(sum / directions * 4 * std::numbers::pi, 1, 0.01);
    }
}

TEST(ChangeCones, SamplesLieInACone) {
    for (const auto& spheres : hard_bounds()) {
        const ChangeCones cones = cones_of(spheres);
        for (std::uint32_t i = 0; i < 1000; ++i) {
            const DirectionSample s = sample_cones(cones, stratified_pair({3, 0, 0, i}, 0));
            EXPECT_NEAR(glm::length(s.direction), 1, 1e-5f);
            EXPECT_GT(s.pdf, 0);
            EXPECT_TRUE(std::isfinite(s.pdf));
        }
    }
}

TEST(ChangeCones, WhatLiesBelowTheHorizonOrHasNoSizeHasNone) {
    EXPECT_EQ(cones_of({}).count, 0);
    EXPECT_EQ(cones_of({{{0, -2, 0}, 1}}).count, 0);
    EXPECT_EQ(cones_of({{{5, -1.1f, 0}, 1}}).count, 0);
    EXPECT_EQ(cones_of({{{0, 2, 0}, 0}}).count, 0);
    EXPECT_EQ(sample_cones(cones_of({}), {0.5f, 0.5f}).pdf, 0);
    EXPECT_EQ(pdf_cones(cones_of({}), up), 0);
}

/// Of an even sky's irradiance, a sphere overhead takes the square of its sine.
TEST(ChangeCones, FillBoundsTheShareOfTheSky) {
    for (const float radius : {0.01f, 0.3f, 0.9f}) {
        const float share = radius * radius;
        const float fill = cones_of({{{0, 1, 0}, radius}}).fill;
        EXPECT_GE(fill, share);
        EXPECT_LE(fill, 2.1f * share);
    }
    EXPECT_EQ(cones_of({{{0, 0, 0}, 1}}).fill, 1);
}

}  // namespace
}  // namespace inlay::test
