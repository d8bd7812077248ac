// E_R for itself: how many samples a pixel takes of it.
#include "render/trace/real_light.h"

#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace inlay::test {
namespace {

/// Samples of a pixel whose light changes by the share `share` of an open surface's, of which
/// `taken` in direct light.
int samples_at(double share, double taken, int secondary) {
    const EnvironmentSampler sky = constant_environment(2);
    const RealGeometry none = no_real_geometry();
    const EmbreeScene empty;
    const TwoModeScene scene{telescope(1, 1), {}, none, empty, sky};
    ChangeSums change;
    change.camera_rays = 4;
    const double whole = share * 2 * std::numbers::pi * change.camera_rays;
    change.direct = glm::dvec3(-taken * whole);
    change.indirect = glm::dvec3((1 - taken) * whole);
    SamplingSettings settings;
    settings.secondary = secondary;
    return real_light_samples(scene, settings, change);
}

TEST(RealLight, GetsFourTimesTheSamplesWhereAChangeIsPlainlySeen) {
    for (const double taken : {0.0, 0.5, 1.0}) {
        EXPECT_EQ(samples_at(0.1, taken, 16), 16);
        EXPECT_EQ(samples_at(0.01, taken, 16), 4);
    }
}

TEST(RealLight, GetsOneSampleAtLeast) {
    EXPECT_EQ(samples_at(0, 1, 1), 1);
    EXPECT_EQ(samples_at(0, 1, 3), 1);
    EXPECT_EQ(samples_at(1, 1, 1), 1);
}

}  // namespace
}  // namespace inlay::test
