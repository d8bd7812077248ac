// The previous frame's samples join where its camera saw the same surface, and nowhere else.
#include "render/baseline/with_previous.h"

#include "tests/support/filter_scenes.h"

#include <gtest/gtest.h>

namespace inlay::test {
namespace {

constexpr double spacing = 0.02;  // m
const FilterSettings settings;

TEST(WithPrevious, AveragesByTheNumberOfSamples) {
    NoisyLayers now = noisy_plane(16, 12, spacing, 1), before = noisy_plane(16, 12, spacing, 5);
    before.samples = 3 * now.samples;
    const NoisyLayers both = with_previous(now, before, settings);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        const Rgb expected = 0.25f * now.direct.e_r.pixels[i] + 0.75f * before.direct.e_r.pixels[i];
        EXPECT_NEAR(both.direct.e_r.pixels[i].g, expected.g, 1e-6);  // rounding of values below 1
    }
    EXPECT_TRUE(same_bits(both.direct.e_rv_virtual, now.direct.e_rv_virtual));
}

TEST(WithPrevious, TakesTheValuesFromWhereThePreviousCameraSawThem) {
    const NoisyLayers now = noisy_plane(16, 12, spacing, 1);
    NoisyLayers before = noisy_plane(16, 12, spacing, 5);
    // That camera was 3 pixels further right, so it saw each place 3 pixels further left.
    before.world_from_camera.translation.x += 3 * spacing;
    for (glm::vec3& p : before.real.position.pixels)
        p.x += float(3 * spacing);
    const NoisyLayers both = with_previous(now, before, settings);
    for (int y = 0; y < 12; ++y) {
        for (int x = 0; x < 16; ++x) {
            const float own = now.direct.e_r(x, y).r;
            const float expected =
                x < 3 ? own : 0.5f * (own + before.direct.e_r(x - 3, y).r);  // x < 3: out of view
            EXPECT_NEAR(both.direct.e_r(x, y).r, expected, 1e-6);
        }
    }
}

TEST(WithPrevious, KeepsThePixelsWhoseSurfaceWasNotSeen) {
    const NoisyLayers now = noisy_plane(16, 12, spacing, 1);
    for (int kind = 0; kind < 3; ++kind) {
        NoisyLayers before = noisy_plane(16, 12, spacing, 5);
        for (std::size_t i = 0; i < before.m.pixels.size(); ++i) {
            if (kind == 0) before.real.object.pixels[i] = 2;
            if (kind == 1) before.real.normal.pixels[i] = {1, 0, 0};
            if (kind == 2) before.real.position.pixels[i].z += 1;
        }
        const NoisyLayers both = with_previous(now, before, settings);
        EXPECT_TRUE(same_bits(both.direct, now.direct)) << kind;
        EXPECT_TRUE(same_bits(both.indirect, now.indirect)) << kind;
    }
}

TEST(WithPrevious, KeepsEqualModesEqualAndConstantsToTheBit) {
    NoisyLayers now = noisy_plane(16, 12, spacing, 1), before = noisy_plane(16, 12, spacing, 5);
    for (NoisyLayers* frame : {&now, &before}) {
        frame->direct.e_rv_real = frame->direct.e_r;
        for (Rgb& e : frame->indirect.e_r.pixels)
            e = Rgb(0.1f, 3.3f, 1e-5f);
    }
    const NoisyLayers both = with_previous(now, before, settings);
    EXPECT_TRUE(same_bits(both.direct.e_r, both.direct.e_rv_real));
    EXPECT_TRUE(same_bits(both.indirect.e_r, now.indirect.e_r));
    EXPECT_FALSE(same_bits(both.direct.e_r, now.direct.e_r));
}

TEST(WithPrevious, LeavesOutValuesThatAreNotFinite) {
    const NoisyLayers now = noisy_plane(16, 12, spacing, 1);
    NoisyLayers before = noisy_plane(16, 12, spacing, 5);
    before.direct.e_rv_real(4, 5) = Rgb(NAN);
    const NoisyLayers both = with_previous(now, before, settings);
    EXPECT_EQ(both.direct.e_r(4, 5), now.direct.e_r(4, 5));
    EXPECT_EQ(both.direct.e_rv_real(4, 5), now.direct.e_rv_real(4, 5));
    EXPECT_NE(both.direct.e_r(5, 5), now.direct.e_r(5, 5));
}

}  // namespace
}  // namespace inlay::test
