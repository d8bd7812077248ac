// Prices between, before and beyond the points that were measured.
#include "composite/govern/price_front.h"

#include "recordings/base/check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

using testing::ElementsAre;
using testing::Field;

/// ms = 10 + 5 n; error = 0.08 n^(-1/2).
const PriceFront lawful{{{4, 30, 0.04}, {16, 90, 0.02}, {64, 330, 0.01}}, 7};

TEST(PriceFront, FollowsALineInTimeAndAPowerLawInError) {
    for (const int samples : {1, 2, 4, 8, 16, 40, 64, 256, 1024}) {
        EXPECT_NEAR(ms_at(lawful, samples), 10 + 5 * samples, 1e-9);
        EXPECT_NEAR(error_at(lawful, samples), 0.08 / std::sqrt(samples), 1e-12);
    }
}

TEST(PriceFront, ALonePointIsProportionalInTimeAndAFourthRootInError) {
    const PriceFront lone{{{16, 80, 0.02}}, 0};
    EXPECT_NEAR(ms_at(lone, 32), 160, 1e-9);
    EXPECT_NEAR(error_at(lone, 256), 0.01, 1e-12);
}

TEST(PriceFront, FewerSamplesCostNoLessThanInProportion) {
    const PriceFront steep{{{8, 1, 0.04}, {16, 100, 0.02}}, 0};
    EXPECT_EQ(ms_at(steep, 1), 0.125);
}

TEST(PriceFront, ErrorsBeyondThePointsFollowABelievableSlope) {
    const PriceFront noisy{{{4, 10, 0.04}, {8, 20, 0.0399}, {16, 30, 0.001}}, 0};
    EXPECT_NEAR(error_at(noisy, 64), 0.001 / 2, 1e-12);
    EXPECT_NEAR(error_at(noisy, 1), 0.04 * std::pow(4, 0.1), 1e-12);
}

TEST(PriceFront, AnErrorOfZeroStaysFinite) {
    const PriceFront exact{{{4, 10, 0.01}, {16, 20, 0}}, 0};
    for (const int samples : {1, 8, 16, 1024})
        EXPECT_TRUE(std::isfinite(error_at(exact, samples)));
}

TEST(PriceFront, WithoutAPointThereIsNoPrice) {
    EXPECT_THROW(ms_at({}, 4), Error);
    EXPECT_THROW(error_at({}, 4), Error);
}

TEST(Pareto, LeavesOutWhatAnotherPointBeatsInBoth) {
    const auto front = pareto({{16, 90, 0.02}, {8, 95, 0.03}, {4, 30, 0.04}, {32, 60, 0.05}});
    EXPECT_THAT(front,
                ElementsAre(Field(&PricePoint::samples, 4), Field(&PricePoint::samples, 16)));
    EXPECT_TRUE(pareto({}).empty());
}

TEST(SampleLadder, HoldsWhatSamplesMayBe) {
    const std::vector<int> ladder = sample_ladder();
    EXPECT_EQ(ladder.front(), 1);
    EXPECT_EQ(ladder.back(), 1024);
    for (std::size_t i = 1; i < ladder.size(); ++i) {
        EXPECT_GT(ladder[i], ladder[i - 1]);
        EXPECT_TRUE(ladder[i] < 4 || ladder[i] % 4 == 0);
    }
}

}  // namespace
}  // namespace inlay
