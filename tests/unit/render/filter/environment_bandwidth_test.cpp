// B_e of spherical Gaussians, of constants, and under rotation.
#include "render/filter/environment_bandwidth.h"

#include "recordings/base/environment_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace inlay {
namespace {

/// ambient + exp(sharpness (d.axis - 1)) at every texel's centre.
Image<Rgb> lobe_map(int width, glm::dvec3 axis, double sharpness, double ambient = 0) {
    Image<Rgb> map(width, width / 2);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec3 d = direction_from_texel(map, {x + 0.5, y + 0.5});
            map(x, y) =
                Rgb(float(ambient + std::exp(sharpness * (glm::dot(d, glm::normalize(axis)) - 1))));
        }
    }
    return map;
}

struct Lobe {
    double sharpness, degree;
};
// The degrees that hold 99 % of a lobe's power, sqrt(-ln(0.01) sharpness) rounded down; +-1 since
// degrees are whole numbers and texels are not points.
const Lobe lobes[] = {{5, 4}, {20, 9}, {100, 21}};

TEST(EnvironmentBandwidth, OfALobeIsWhatItsSharpnessSays) {
    for (const Lobe& lobe : lobes)
        EXPECT_NEAR(environment_bandwidth(lobe_map(256, {1, 0, 0}, lobe.sharpness)), lobe.degree, 1)
            << "sharpness " << lobe.sharpness;
}

TEST(EnvironmentBandwidth, DoesNotChangeWhenTheLobeTurns) {
    for (const Lobe& lobe : lobes) {
        const double at_equator = environment_bandwidth(lobe_map(256, {1, 0, 0}, lobe.sharpness));
        for (const glm::dvec3& axis : {glm::dvec3(0, 1, 0), {0.3, -1, 0.1}, {1, 1, 0}, {-1, 0, -2}})
            EXPECT_EQ(environment_bandwidth(lobe_map(256, axis, lobe.sharpness)), at_equator);
    }
}

TEST(EnvironmentBandwidth, DoesNotDependOnTheMapsSize) {
    for (const Lobe& lobe : lobes) {
        for (const int width : {200, 256, 600, 1024})  // texels shift a whole degree at most
            EXPECT_NEAR(environment_bandwidth(lobe_map(width, {1, 2, 3}, lobe.sharpness)),
                        lobe.degree, 1)
                << width;
    }
}

TEST(EnvironmentBandwidth, CountsTheEdgesOfTexelsThatDoNotResolveALobe) {
    // texels are constant: of 5.6 degrees they make steps out of a lobe of 5.7 degrees
    EXPECT_GT(environment_bandwidth(lobe_map(64, {1, 2, 3}, 100)), 40);
}

TEST(EnvironmentBandwidth, LeavesTheMeanOut) {
    // with its mean a bright ambient hides the lobe: 6 in place of 9 for 0.3 + lobe
    EXPECT_EQ(environment_bandwidth(lobe_map(256, {1, 0, 0}, 20, 0.3)),
              environment_bandwidth(lobe_map(256, {1, 0, 0}, 20)));
}

TEST(EnvironmentBandwidth, OfAConstantIsZeroAtEverySize) {
    for (const int height : {1, 4, 33, 128, 300})
        EXPECT_EQ(environment_bandwidth(Image<Rgb>(2 * height, height, Rgb(0.7f, 0.1f, 3.0f))), 0);
    EXPECT_EQ(environment_bandwidth(Image<Rgb>(64, 32, Rgb(0))), 0);
    EXPECT_EQ(environment_bandwidth(Image<Rgb>()), 0);
}

TEST(EnvironmentBandwidth, OfOneHotTexelIsTheLargestDegree) {
    for (const int row : {0, 40, 127}) {
        Image<Rgb> map(256, 128, Rgb(0.5f));
        map(100, row) = Rgb(5e4f);
        EXPECT_EQ(environment_bandwidth(map), environment_degrees - 1);
    }
}

TEST(EnvironmentBandwidth, TakesTexelsThatAreNotNumbersForBlack) {
    Image<Rgb> broken = lobe_map(256, {1, 0, 0}, 20);
    Image<Rgb> black = broken;
    broken(7, 60) = Rgb(NAN, 1, INFINITY);
    black(7, 60) = Rgb(0);
    EXPECT_EQ(environment_bandwidth(broken), environment_bandwidth(black));
}

TEST(SphericalHarmonicPowers, AddUpToTheIntegralOfTheSquare) {
    // Parseval; a lobe of sharpness 20 has nothing beyond degree 63. 2e-3: luminance is integrated
    // texel by texel.
    const Image<Rgb> map = lobe_map(256, {1, 2, 0.5}, 20, 0.1);
    double square = 0, sum = 0;
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x)
            square += texel_solid_angle(map, y) * std::pow(double(luminance(map(x, y))), 2);
    }
    for (const double power : spherical_harmonic_powers(map))
        sum += power;
    EXPECT_NEAR(sum / square, 1, 2e-3);
}

}  // namespace
}  // namespace inlay
