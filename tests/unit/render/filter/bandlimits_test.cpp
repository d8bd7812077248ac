// Bandlimits against closed forms, beside the printed formulas that fail.
#include "render/filter/bandlimits.h"

#include "recordings/base/check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace inlay {
namespace {

using std::numbers::pi;

/// The share of the clamped cosine's energy in |w| < bandwidth: its Fourier transform is
/// 2 cos(pi w / 2) / (1 - w^2), and by Parseval the whole is 2 pi times the integral of cos^2.
double cosine_energy_within(double bandwidth) {
    const int steps = 200000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double w = bandwidth * (i + 0.5) / steps, gap = 1 - w * w;
        const double f = std::abs(gap) < 1e-7 ? pi / 2 : 2 * std::cos(pi * w / 2) / gap;
        sum += 2 * f * f * bandwidth / steps;
    }
    return sum / (2 * pi * pi / 2);
}

TEST(CosineBandlimit, HoldsNinetyNinePercentOfTheEnergy) {
    // the golden widths have four digits, and the energy's slope there is below 0.4
    EXPECT_NEAR(cosine_energy_within(2.363), 0.99, 2e-4);
    EXPECT_NEAR(cosine_energy_within(1.822), 0.95, 2e-4);
    EXPECT_NEAR(cosine_energy_within(cosine_bandlimit), 0.99, 2e-4);
    EXPECT_LT(cosine_energy_within(1.0), 0.7);  // the thesis's B_f
}

TEST(OccluderRate, IsHowFastTheBlockedAngleMoves) {
    const double z = 0.7;  // m, height of a blocker that is infinite to one side
    for (const double angle : {-1.2, -0.4, 0.0, 0.8, 1.3}) {
        const auto blocked = [&](double x) { return std::atan((z * std::tan(angle) - x) / z); };
        const double rate = (blocked(-1e-5) - blocked(1e-5)) / 2e-5;
        const double r = z / std::cos(angle);
        EXPECT_NEAR(occluder_rate(std::cos(angle), r), rate, 1e-7);  // of the central difference
        if (angle != 0) {
            EXPECT_LT(std::cos(angle) * std::cos(angle) / r, 0.95 * rate);
        }
    }
}

TEST(Bandwidth, IsZeroOnAnUnoccludedPlane) {
    const LocalFrequencies plane{0, 0, 26, 10};
    EXPECT_EQ(direct_bandwidth(plane), 0);
    EXPECT_EQ(indirect_bandwidth(plane), 0);
    EXPECT_EQ(thesis_direct_bandwidth(plane), 0);
    EXPECT_EQ(inverse_width(plane, LightKind::direct, {}), 0);
}

TEST(Bandwidth, ThesisFormsAreThePrintedOnes) {
    EXPECT_DOUBLE_EQ(thesis_direct_bandwidth({0.5, 0.5, 3}), 2.5);  // its fig. 6.5
    EXPECT_DOUBLE_EQ(thesis_direct_bandwidth({2, 3, 4, 10}), 2 * 21 + 3 * 25);
    EXPECT_DOUBLE_EQ(thesis_indirect_bandwidth({2, 3, 4}), 3 * 2.8);
    FilterSettings thesis;
    thesis.constants = FilterConstants::thesis;
    EXPECT_DOUBLE_EQ(inverse_width({0.5, 0.5, 3}, LightKind::direct, thesis), 5);  // eq. 6.23
    EXPECT_EQ(sample_factor(256, thesis), 1);
}

TEST(Bandwidth, CountsTheLobeOncePerOccluder) {
    const LocalFrequencies f{0, 3, 4, 10};
    EXPECT_DOUBLE_EQ(direct_bandwidth(f), 3 * (cosine_bandlimit + 10 + 4));
    EXPECT_DOUBLE_EQ(direct_bandwidth({2, 0, 4, 10}), 2 * (cosine_bandlimit + 20));
}

TEST(Bandwidth, StaysPositiveWhereTheSurfaceIsHollow) {
    // the printed sum of signed terms vanishes at kappa = -c (1 + B_e), where light still changes
    const double c = 0.5, environment = 3;
    const LocalFrequencies hollow{-c * (1 + environment), c, environment};
    EXPECT_EQ(thesis_direct_bandwidth(hollow), 0);
    EXPECT_GT(direct_bandwidth(hollow), 3);
    EXPECT_DOUBLE_EQ(direct_bandwidth({-c, c, 0}), 0.1 * c * cosine_bandlimit);
}

TEST(InverseWidth, HasASafetyFactorForEachTerm) {
    const FilterSettings s;
    EXPECT_DOUBLE_EQ(inverse_width({-2, 0, 9}, LightKind::direct, s), 2 * cosine_bandlimit / 0.2);
    EXPECT_DOUBLE_EQ(inverse_width({0, 3, 9}, LightKind::direct, s), 3 * (cosine_bandlimit + 9));
    EXPECT_DOUBLE_EQ(inverse_width({0, 3, 9}, LightKind::indirect, s), 3 * 3.65);
    // sigma kappa <= 0.085: the gradient of irradiance on a sphere loses less than 1 %
    const double turn = 1 / inverse_width({1, 0, 0}, LightKind::direct, s);
    EXPECT_GT(std::exp(-turn * turn), 0.99);
}

TEST(SampleFactor, HalvesTheWidthWithSixteenTimesTheSamples) {
    EXPECT_DOUBLE_EQ(sample_factor(16, {}), 1);
    EXPECT_DOUBLE_EQ(sample_factor(256, {}), 0.5);
    EXPECT_DOUBLE_EQ(sample_factor(0, {}), 2);
}

TEST(ClampedBandwidth, AlwaysGivesANumber) {
    EXPECT_EQ(clamped_bandwidth(NAN), largest_bandwidth);
    EXPECT_EQ(clamped_bandwidth(std::numeric_limits<double>::infinity()), largest_bandwidth);
    EXPECT_EQ(clamped_bandwidth(-3), 0);
    EXPECT_EQ(clamped_bandwidth(12.5), 12.5);
}

TEST(PairCurvature, OfTheSameNormalsIsExactlyZero) {
    const glm::vec3 n = glm::normalize(glm::vec3(0.3f, -0.4f, 0.2f));
    EXPECT_EQ(pair_curvature({0, 0, 0}, n, {0.01f, 0, 0}, n, 0.01), 0);
    EXPECT_EQ(pair_curvature({0, 0, 0}, n, {0, 0, 0}, n, 0.01), 0);
}

TEST(PairCurvature, SeesSmallAnglesThatArcCosineLoses) {
    const float angle = 1e-4f;
    const glm::vec3 n(0, 0, 1), m(std::sin(angle), 0, std::cos(angle));
    // 1 %: the angle's sine has its full seven digits
    EXPECT_NEAR(pair_curvature({0, 0, 0}, n, {0.001f, 0, 0}, m, 0.001), 0.1, 0.001);
    EXPECT_EQ(std::acos(glm::dot(n, m)), 0.0f);  // what eq. 6.20 gives when read as arc cosine
}

TEST(PairCurvature, IsPositiveOnTheOutsideOfACylinderAndTheSameBothWays) {
    const float a = 0.05f;
    const glm::vec3 n(-std::sin(a), 0, std::cos(a)), m(std::sin(a), 0, std::cos(a));
    EXPECT_NEAR(pair_curvature(2.0f * n, n, 2.0f * m, m, 0), 0.5, 1e-3);  // chord for arc
    EXPECT_NEAR(pair_curvature(2.0f * n, -n, 2.0f * m, -m, 0), -0.5, 1e-3);
    EXPECT_EQ(pair_curvature(2.0f * n, n, 2.0f * m, m, 0),
              pair_curvature(2.0f * m, m, 2.0f * n, n, 0));
}

/// A sphere of radius 0.5 m seen through a pinhole from 2 m; `side` -1: from its inside's normals.
Receiver sphere_seen(const Lens& lens, float side) {
    const Image<glm::vec3> vectors(lens.width, lens.height, glm::vec3(0));
    const Image<float> numbers(lens.width, lens.height, 0.0f);
    Receiver r{Image<std::uint32_t>(lens.width, lens.height, 0), vectors, vectors, numbers,
               numbers};
    const glm::dvec3 centre(0, 0, 2);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::dvec3 d = glm::normalize(unproject(lens, {double(x), double(y)}));
            const double b = glm::dot(d, centre), disc = b * b - 4 + 0.25;
            if (disc <= 0) continue;
            const glm::dvec3 p = (b - std::sqrt(disc)) * d;
            r.object(x, y) = 1;
            r.position(x, y) = glm::vec3(p);
            r.normal(x, y) = side * glm::vec3((p - centre) / 0.5);
        }
    }
    return r;
}

TEST(ScreenCurvature, OfASphereIsOneOverItsRadius) {
    const Lens lens{128, 128, 200, 200, 63.5, 63.5};
    for (const float side : {1.0f, -1.0f}) {
        const Receiver r = sphere_seen(lens, side);
        const Image<float> footprint = pixel_footprint(r, lens, {});
        const ScreenCurvature kappa = screen_curvature(r, footprint);
        int pixels = 0;
        for (int y = 0; y < 128; ++y) {
            for (int x = 0; x < 128; ++x) {
                if (r.object(x, y) == 0 || r.normal(x, y).z * side > -0.3f) continue;
                ++pixels;
                // 0.5 %: chord for arc is 1 - angle^2 / 24 at up to 0.15 rad between pixels, and
                // single precision leaves 1e-7 of angles of 0.01
                EXPECT_NEAR(kappa.x(x, y), side * 2, 0.01);
                EXPECT_NEAR(kappa.y(x, y), side * 2, 0.01);
            }
        }
        EXPECT_GT(pixels, 3000);
    }
}

TEST(ScreenCurvature, LeavesPairsAcrossDepthEdgesOut) {
    // two planes that face the camera a little differently, one 0.5 m behind the other
    const Lens lens{16, 16, 100, 100, 7.5, 7.5};
    Receiver r = sphere_seen(lens, 1);
    const glm::vec3 left(0, 0, -1), right = glm::normalize(glm::vec3(0.1f, 0, -1));
    for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
            const glm::vec3 ray(unproject(lens, {double(x), double(y)}));
            r.object(x, y) = 1;
            r.normal(x, y) = x < 8 ? left : right;
            r.position(x, y) = x < 8 ? ray * 1.5f : ray * (2.0f / (1 - 0.1f * ray.x));
        }
    }
    const ScreenCurvature kappa = screen_curvature(r, pixel_footprint(r, lens, {}));
    for (const float k : kappa.x.pixels)
        EXPECT_EQ(k, 0.0f);
}

TEST(PixelFootprint, GrowsWithDepth) {
    const Lens lens{128, 128, 200, 200, 63.5, 63.5};
    const Image<float> footprint = pixel_footprint(sphere_seen(lens, 1), lens, {});
    EXPECT_NEAR(footprint(64, 64), 1.5 / 200, 1e-5);
    EXPECT_EQ(footprint(0, 0), 0.0f);
}

TEST(Bandlimits, DurandsDoNotKnowTheLight) {
    EXPECT_EQ(durand_bandwidth({}), 0);
    EXPECT_DOUBLE_EQ(durand_bandwidth({2, 3, 4}), 2 * 2 + 3);  // B_f = 1
    EXPECT_DOUBLE_EQ(durand_bandwidth({2, 3, 4, 10}), (2 * 2 + 3) * 10);
    EXPECT_DOUBLE_EQ(durand_bandwidth({-2, 3, 4}), 1);
    EXPECT_EQ(durand_bandwidth({1, 2, 100}), durand_bandwidth({1, 2, 0}));
    FilterSettings durand;
    durand.constants = FilterConstants::durand;
    for (const LightKind light : {LightKind::direct, LightKind::indirect})
        EXPECT_DOUBLE_EQ(inverse_width({2, 3, 4}, light, durand), 14);  // eq. 6.23
    EXPECT_EQ(sample_factor(256, durand), 1);
    EXPECT_EQ(durand_bandwidth({0, INFINITY, 0}), largest_bandwidth);
}

TEST(FilterSettings, AreRefusedOutOfRangeByName) {
    FilterSettings s;
    s.normal_stop_deg = 90;
    try {
        validate(s);
        ADD_FAILURE() << "a stop of 90 degrees lets every normal through";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::usage);
        EXPECT_NE(std::string(e.what()).find("normal_stop_deg"), std::string::npos);
    }
}

}  // namespace
}  // namespace inlay
