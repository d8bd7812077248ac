// PixelSums: means of what was added, with non-finite samples left out and counted.
#include "render/trace/pixel_sums.h"

#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace inlay::test {
namespace {

TEST(SampleSum, LeavesOutAndCountsWhatIsNotFinite) {
    SampleSum sum;
    sum.add(Rgb(1));
    sum.add(Rgb(NAN, 0, 0));
    sum.add(Rgb(0, INFINITY, 0));
    sum.add(Rgb(3));
    EXPECT_EQ(sum.mean(), Rgb(2));
    EXPECT_EQ(sum.dropped, 2);
    EXPECT_EQ(SampleSum{}.mean(), Rgb(0));
}

TEST(PairedSum, DropsASampleFromBothModesOrFromNone) {
    PairedSum pair;
    pair.add(Rgb(1), Rgb(2));
    pair.add(Rgb(5), Rgb(NAN));
    pair.add(Rgb(INFINITY), Rgb(7));
    EXPECT_EQ(pair.e_r.mean(), Rgb(1));
    EXPECT_EQ(pair.e_rv.mean(), Rgb(2));
    EXPECT_EQ(pair.e_r.count, pair.e_rv.count);
    EXPECT_EQ(pair.e_r.dropped, 2);
}

TEST(Store, DividesEachSumByItsOwnCount) {
    PixelSums sums;
    sums.looks = 4;
    sums.real.hits = 3;
    sums.real.object = 1;
    sums.real.normal = {0, 0, 6};
    sums.real.position = {3, 0, 6};
    sums.virtual_.hits = 1;
    sums.looks_virtual = 1;
    for (int i = 0; i < 3; ++i)
        sums.direct.add(Rgb(2), Rgb(1));
    sums.direct_virtual.add(Rgb(5));
    sums.albedo.add(Rgb(0.5f));
    sums.glossy_direct.add(Rgb(1));
    sums.glossy_indirect.add(Rgb(2));
    NoisyLayers layers = make_noisy_layers(lens_of(2, 2, 1), {}, {});
    store(sums, 1, 0, layers);
    EXPECT_EQ(layers.m(1, 0), 0.75f);
    EXPECT_EQ(layers.direct.e_r(1, 0), Rgb(2));
    EXPECT_EQ(layers.direct.e_rv_real(1, 0), Rgb(1));
    EXPECT_EQ(layers.direct.e_rv_virtual(1, 0), Rgb(5));
    EXPECT_EQ(layers.s_rv(1, 0), Rgb(3));
    EXPECT_TRUE(near(layers.k_v(1, 0), glm::dvec3(0.5 / std::numbers::pi), 1e-7));
    EXPECT_TRUE(near(layers.real.position(1, 0), {1, 0, 2}, 1e-7));
    EXPECT_EQ(layers.real.normal(1, 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(layers.m(0, 0), 1);  // untouched: no virtual surface
}

TEST(Store, NormalsThatCancelStillGiveAUnitVector) {
    PixelSums sums;
    sums.looks = 2;
    sums.real.hits = 2;
    sums.real.object = 1;
    NoisyLayers layers = make_noisy_layers(lens_of(1, 1, 1), {}, {});
    store(sums, 0, 0, layers);
    EXPECT_NEAR(glm::length(layers.real.normal(0, 0)), 1, 1e-6);
}

}  // namespace
}  // namespace inlay::test
