// Environment files and tools: the mapping of OpenEXR's own orientation map, lobes against their
// closed form, alignment with the world.
#include "recordings/base/check.h"
#include "recordings/environment/environment_tools.h"
#include "recordings/environment/exr_image.h"
#include "recordings/environment/latlong_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <string>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using std::numbers::pi;

const fs::path maps = fs::path(INLAY_DATA_DIR) / "environments";

/// Share of dark texels on the arc from `from` towards `to`, 3 to 17 degrees, the line's width
/// aside.
double dark_share(const EnvironmentMap& map, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 across = glm::cross(from, to);
    int dark = 0, all = 0;
    for (double degrees = 3; degrees <= 17; degrees += 0.5, ++all) {
        const double a = degrees * pi / 180;
        const glm::dvec3 centre = std::cos(a) * from + std::sin(a) * to;
        bool found = false;
        for (double side = -0.012; side <= 0.012; side += 0.003)
            found |= luminance(radiance_from(
                         map, glm::vec3(glm::normalize(centre + side * across)))) < 0.2f;
        dark += found;
    }
    return double(dark) / all;
}

TEST(OrientationMap, DrawsItsAxesWhereOursPoint) {
    const fs::path file = maps / "OrientationLatLong.exr";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
    const LatlongFile loaded = load_latlong(file);
    EXPECT_EQ(loaded.radiance.width, 1024);
    EXPECT_EQ(loaded.radiance.height, 512);
    // About +x, -x and +z it draws dark lines along the other axes, in their positive sense only.
    const EnvironmentMap map{loaded.radiance};
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    for (const auto& [view, side] : {std::pair(x, z), std::pair(-x, z), std::pair(z, x)}) {
        EXPECT_GT(dark_share(map, view, y), 0.9);
        EXPECT_GT(dark_share(map, view, side), 0.9);
        EXPECT_LT(dark_share(map, view, -side), 0.2);
    }
    EXPECT_LT(dark_share(map, -z, -x), 0.2);
    EXPECT_GT(dark_share(map, -z, x), 0.9);
}

TEST(LatlongFiles, EveryMapAtHandIsReadAndItsNegativeTexelsCounted) {
    if (!fs::exists(maps)) GTEST_SKIP() << maps << " is absent";
    // Counted independently, with OpenCV's reader.
    const std::map<std::string, int> negative{
        {"city.exr", 299}, {"courtyard.exr", 1188},     {"interior.exr", 5053},
        {"studio.exr", 3}, {"KernerEnvLatLong.exr", 0}, {"OrientationLatLong.exr", 0}};
    for (const auto& [name, count] : negative) {
        const LatlongFile map = load_latlong(maps / name);
        EXPECT_EQ(map.radiance.width, 2 * map.radiance.height) << name;
        EXPECT_EQ(map.replaced_texels, count) << name;
        EXPECT_GT(luminance(mean_radiance(map.radiance)), 0) << name;
        for (const Rgb& texel : map.radiance.pixels)
            ASSERT_TRUE(std::isfinite(texel.r + texel.g + texel.b) && texel.r >= 0 &&
                        texel.g >= 0 && texel.b >= 0)
                << name;
    }
}

TEST(ExrChannels, AreTheColorOfTheSameFile) {
    const fs::path file = maps / "studio.exr";
    if (!fs::exists(file)) GTEST_SKIP() << file << " is absent";
    const Image<Rgb> color = read_exr(file);
    const std::vector<ExrChannel> channels = read_exr_channels(file);
    ASSERT_EQ(channels.size(), 3u);  // B, G, R
    for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(channels[std::size_t(c)].name, std::string(1, "BGR"[c]));
        for (std::size_t i = 0; i < color.pixels.size(); i += 997)
            EXPECT_EQ(color.pixels[i][2 - c], channels[std::size_t(c)].values.pixels[i]);
    }
}

TEST(Lobes, CarryThePowerOfTheClosedForm) {
    for (const double sharpness : {0.0, 0.5, 5.0, 40.0, 1000.0, 1e5}) {
        const glm::dvec3 direction = glm::normalize(glm::dvec3(0.3, 0.5, -0.8));
        const Image<Rgb> map = make_lobes(Rgb(0), {{direction, sharpness, Rgb(1, 2, 0)}});
        const Rgb power = mean_radiance(map) * float(4 * pi);
        const double expected =
            sharpness > 0 ? 2 * pi * (1 - std::exp(-2 * sharpness)) / sharpness : 4 * pi;
        // The midpoint rule with a tenth of the lobe's width between points.
        EXPECT_NEAR(power.r / expected, 1, 2e-3) << sharpness;
        EXPECT_NEAR(power.g / expected, 2, 4e-3) << sharpness;
        EXPECT_EQ(power.b, 0);
    }
}

TEST(Lobes, AreBrightestAtTheirDirection) {
    const glm::dvec3 direction = glm::normalize(glm::dvec3(-0.6, 0.2, 0.4));
    const EnvironmentMap map{make_lobes(Rgb(0.1f), {{direction, 40, Rgb(3)}})};
    EXPECT_NEAR(radiance_from(map, glm::vec3(direction)).r, 3.1,
                0.05);  // half a texel away at most
    EXPECT_NEAR(radiance_from(map, glm::vec3(-direction)).r, 0.1, 1e-6);
}

TEST(Irradiance, OfAConstantIsPiTimesIt) {
    const EnvironmentMap map{make_constant(Rgb(0.5f, 1, 2))};
    for (const glm::dvec3& n :
         {glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0), glm::normalize(glm::dvec3(1, -2, 0.5))}) {
        const Rgb e = irradiance_from_environment(map, n);
        EXPECT_NEAR(e.g / pi, 1, 1e-4);  // 32 x 32 points in texels that the horizon cuts
        EXPECT_NEAR(e.b / e.r, 4, 1e-5);
    }
}

TEST(Irradiance, OfANarrowLobeIsItsPowerTimesTheCosine) {
    const double sharpness = 2000;
    const EnvironmentMap map{make_lobes(Rgb(0), {{glm::dvec3(0, 1, 0), sharpness, Rgb(100)}})};
    const double power = 100 * 2 * pi / sharpness;
    for (const double angle : {0.0, 0.5, 1.0, 1.4}) {
        const Rgb e = irradiance_from_environment(map, {std::sin(angle), std::cos(angle), 0});
        const double mean_cosine = 1 - 1 / sharpness;  // of the lobe about its axis
        EXPECT_NEAR(e.r / power, std::cos(angle) * mean_cosine, 2e-3) << angle;  // as the power
    }
}

TEST(Alignment, TurnsUpAndForwardAsDescribed) {
    const glm::dvec3 up = glm::normalize(glm::dvec3(0.1, -0.9, -0.4)), forward(0.2, 0.1, 1);
    const glm::dmat3 m = align_environment(up, 2.0 * forward, 0);
    EXPECT_LT(glm::length(m[1] - up), 1e-12);  // rounding, here and below
    EXPECT_NEAR(glm::dot(glm::cross(m[2], forward), glm::cross(up, forward)), 0, 1);
    const glm::dvec3 horizontal = glm::normalize(forward - glm::dot(forward, up) * up);
    EXPECT_LT(glm::length(m[2] - horizontal), 1e-12);
    EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
}

TEST(Alignment, TurnsCounterClockwiseSeenFromAbove) {
    const glm::dvec3 up(0, 1, 0), forward(0, 0, 1);
    // Seen from above (+y towards the eye) with +x to the right, +z points down: counter-clockwise
    // from +z comes +x.
    EXPECT_LT(glm::length(align_environment(up, forward, 90)[2] - glm::dvec3(1, 0, 0)), 1e-12);
    EXPECT_LT(glm::length(align_environment(up, forward, 30)[2] -
                          glm::dvec3(std::sin(pi / 6), 0, std::cos(pi / 6))),
              1e-12);
}

TEST(Alignment, HasARotationWhenForwardIsUp) {
    for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1), glm::dvec3(1, 0, 0)}) {
        const glm::dmat3 m = align_environment(up, -up, 20);
        EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
        EXPECT_LT(glm::length(m[1] - up), 1e-12);
    }
}

}  // namespace
}  // namespace inlay
