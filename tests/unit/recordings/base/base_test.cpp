// The shared vocabulary: color, lens, pose, environment mapping, random numbers.
#include "recordings/base/color.h"
#include "recordings/base/environment_map.h"
#include "recordings/base/lens.h"
#include "recordings/base/parallel.h"
#include "recordings/base/pose.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace inlay {
namespace {

TEST(Color, EncodeUndoesDecodeForEveryByte) {
    for (int i = 0; i < 256; ++i) {
        const auto byte = std::uint8_t(i);
        EXPECT_EQ(encode(decode(EncodedRgb{byte, 0, byte})), (EncodedRgb{byte, 0, byte}));
    }
}

TEST(Color, EncodeClampsWhatABytecannotHold) {
    EXPECT_EQ(encode(Rgb(-1.0f, 2.0f, NAN)), (EncodedRgb{0, 255, 0}));
}

TEST(Lens, TopLeftPixelCentreIsTheOrigin) {
    const Lens lens{640, 480, 500, 500, 0, 0};
    EXPECT_EQ(unproject(lens, {0, 0}), glm::dvec3(0, 0, 1));
    EXPECT_EQ(nearest_pixel(lens, {-0.49, 0.49}), glm::ivec2(0, 0));
    EXPECT_FALSE(nearest_pixel(lens, {-0.51, 0}).has_value());
    EXPECT_FALSE(nearest_pixel(lens, {NAN, 0}).has_value());
}

TEST(Lens, UnprojectUndoesProjectWithAndWithoutDistortion) {
    Lens lens{640, 480, 517.3, 516.5, 318.6, 255.3};
    for (const bool distort : {false, true}) {
        if (distort) {
            lens.k1 = 0.2624, lens.k2 = -0.9531, lens.k3 = 1.1633;
            lens.p1 = -0.0054, lens.p2 = 0.0026;
        }
        for (double y = 0; y < 480; y += 47) {
            for (double x = 0; x < 640; x += 53) {
                const glm::dvec2 back = project(lens, 2.5 * unproject(lens, {x, y}));
                EXPECT_NEAR(back.x, x, 1e-6);  // px; the iteration stops at 1e-10 of a unit
                EXPECT_NEAR(back.y, y, 1e-6);
            }
        }
    }
}

TEST(Lens, ScalingKeepsTheImageCorners) {
    const Lens lens{640, 480, 525, 525, 319.5, 239.5};
    const Lens half = scaled(lens, 320, 240);
    EXPECT_DOUBLE_EQ(half.cx, 159.5);  // the centre stays the centre
    EXPECT_DOUBLE_EQ(half.cy, 119.5);
    EXPECT_DOUBLE_EQ(half.fx, 262.5);
}

TEST(Pose, InverseUndoesThePose) {
    const Pose b_from_a{glm::mat3_cast(glm::angleAxis(1.1, glm::normalize(glm::dvec3(1, 2, 3)))),
                        {0.3, -2, 5}};
    const glm::dvec3 p_a{1, -4, 0.5};
    EXPECT_LT(glm::length(inverse(b_from_a) * (b_from_a * p_a) - p_a), 1e-12);  // rounding
    EXPECT_NEAR(rotation_angle(Pose{}, b_from_a), 1.1, 1e-12);
    EXPECT_NEAR(rotation_angle(Pose{}, interpolate(Pose{}, b_from_a, 0.25)), 0.275, 1e-12);
}

TEST(EnvironmentMap, DirectionsLieWhereOpenExrPutsThem) {
    const Image<Rgb> map(64, 32);
    EXPECT_NEAR(texel_from_direction(map, {0, 0, 1}).x, 32, 1e-9);  // centre looks along +z
    EXPECT_NEAR(texel_from_direction(map, {1, 0, 0}).x, 16, 1e-9);  // left quarter along +x
    EXPECT_NEAR(texel_from_direction(map, {0, 1, 0}).y, 0, 1e-9);   // +y is up
}

TEST(EnvironmentMap, TexelAndDirectionUndoEachOther) {
    const Image<Rgb> map(64, 32);
    for (double y = 0.5; y < 32; ++y) {
        for (double x = 0.25; x < 64; x += 3.1) {
            const glm::dvec2 back = texel_from_direction(map, direction_from_texel(map, {x, y}));
            EXPECT_NEAR(back.x, x, 1e-9);
            EXPECT_NEAR(back.y, y, 1e-9);
        }
    }
}

TEST(EnvironmentMap, SolidAnglesSumToTheSphere) {
    const Image<Rgb> map(20, 10);
    double sum = 0;
    for (int y = 0; y < map.height; ++y)
        sum += map.width * texel_solid_angle(map, y);
    EXPECT_NEAR(sum, 4 * std::numbers::pi, 1e-12);
}

TEST(Random, PairsOfOnePixelFallIntoDifferentStrata) {
    // A (0, 2)-sequence: 16 points put exactly one into each cell of a 4 x 4, 16 x 1 and 1 x 16
    // grid.
    for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
        int cells[16] = {}, columns[16] = {}, rows[16] = {};
        for (std::uint32_t s = 0; s < 16; ++s) {
            const glm::vec2 u = stratified_pair({1, 2, pixel, s}, 7);
            ++cells[int(u.x * 4) * 4 + int(u.y * 4)];
            ++columns[int(u.x * 16)];
            ++rows[int(u.y * 16)];
        }
        for (int i = 0; i < 16; ++i) {
            EXPECT_EQ(cells[i], 1);
            EXPECT_EQ(columns[i], 1);
            EXPECT_EQ(rows[i], 1);
        }
    }
}

TEST(Random, PairsOfDifferentDimensionsAreUncorrelated) {
    double sum = 0;
    const int n = 4000;
    for (std::uint32_t pixel = 0; pixel < n; ++pixel)
        sum += (stratified_pair({1, 0, pixel, 3}, 0).x - 0.5) *
               (stratified_pair({1, 0, pixel, 3}, 1).x - 0.5);
    EXPECT_LT(std::abs(sum / n), 4 * (1.0 / 12) / std::sqrt(n));  // 4 standard errors
}

TEST(Parallel, SumsAddInOrderForAnyNumberOfThreads) {
    const auto term = [](int i) { return 1.0 / (1 + i); };
    set_thread_count(1);
    const double one = ordered_sum(10000, term);
    set_thread_count(2);
    EXPECT_EQ(one, ordered_sum(10000, term));
}

}  // namespace
}  // namespace inlay
