// The governor against machines and scenes whose prices are known and unlike the front's.
#include "composite/govern/governor.h"

#include "composite/govern/measure_front.h"
#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

/// ms = 10 + 5 n; error = 0.08 n^(-1/2).
const PriceFront front{{{4, 30, 0.04}, {16, 90, 0.02}, {64, 330, 0.01}}, 40};

Goal by_time(double ms) { return {ms, {}}; }
Goal by_error(double error) { return {{}, error}; }

TEST(Governor, TakesTheMostSamplesThatFitAndTheFewestThatDo) {
    const Choice timed = choose(start_governor(by_time(201), front));
    EXPECT_EQ(timed.samples, 28);  // 40 + 10 + 5 n <= 0.98 * 201
    EXPECT_NEAR(timed.ms, 190, 1e-9);
    const Choice exact = choose(start_governor(by_error(0.01), front));
    EXPECT_EQ(exact.samples, 72);  // 0.08 / sqrt(n) <= 0.0095
}

TEST(Governor, WhatCannotBeReachedIsComeNear) {
    EXPECT_EQ(choose(start_governor(by_time(0.1), front)).samples, 1);
    EXPECT_EQ(choose(start_governor(by_error(0), front)).samples, 1024);
    EXPECT_EQ(choose(start_governor(by_error(1e9), front)).samples, 1);
}

TEST(Governor, RefusesGoalsThatAreNone) {
    EXPECT_THROW(start_governor({}, front), Error);
    EXPECT_THROW(start_governor({100.0, 0.1}, front), Error);
    for (const double bad : {0.0, -1.0, double(NAN), double(INFINITY)})
        EXPECT_THROW(start_governor(by_time(bad), front), Error);
    for (const double bad : {-1.0, double(NAN), double(INFINITY)})
        EXPECT_THROW(start_governor(by_error(bad), front), Error);
}

/// A machine half as fast as the front says, whose scene gets 1 % dearer with each frame up to
/// twice as dear, and back. Times stray by 4 % evenly either way. The choice aims at 2 % less than
/// asked and follows within a few frames, so that few frames are late by more than 10 %.
TEST(Governor, KeepsTheTimeWhileTheScenePricesChange) {
    const Goal goal = by_time(300);
    Governor governor = start_governor(goal, front);
    int late = 0, early = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const Choice choice = choose(governor);
        const double dearer = 2 * (1 + 0.01 * (frame < 50 ? frame : 100 - frame));
        const double stray = 1 + 0.08 * (uniform({1, std::uint32_t(frame), 0, 0}, 0) - 0.5);
        const double sampling = dearer * stray * (10 + 5 * choice.samples), other = 45;
        late += sampling + other > 1.1 * *goal.ms_per_frame;
        early += sampling + other < 0.7 * *goal.ms_per_frame;  // a step of the ladder, and strays
        learn(governor, choice, {sampling, other, false, {}});
    }
    EXPECT_LE(late, 10);
    EXPECT_LE(early, 10);
}

/// Errors twice the front's, seen every tenth frame with 10 % of noise. The first frames are chosen
/// before any is seen; one look halves the mistake, two leave a quarter.
TEST(Governor, KeepsTheErrorThatItIsTold) {
    const Goal goal = by_error(0.02);
    Governor governor = start_governor(goal, front);
    int missed = 0;
    for (int frame = 0; frame < 100; ++frame) {
        const Choice choice = choose(governor);
        const double factor = 2, error = factor * 0.08 / std::sqrt(choice.samples);
        missed += error > 1.2 * *goal.error;
        Reached reached{100, 40, false, {}};
        if (frame % 10 == 0)
            reached.error = factor * (0.9 + 0.2 * uniform({2, std::uint32_t(frame), 0, 0}, 0));
        learn(governor, choice, reached);
    }
    EXPECT_LE(missed, 20);
    EXPECT_NEAR(governor.error_factor, 2, 0.3);
}

/// Every tenth frame takes 60 ms more than the other 40, and the first both: from the second one on
/// its choice allows for that.
TEST(Governor, FramesThatExtractTheModelAreForeseen) {
    Governor governor = start_governor(by_time(300), {front.points, 100});
    for (int frame = 0; frame < 40; ++frame) {
        const bool extracts = frame % 10 == 0;
        const Choice choice = choose(governor, extracts);
        const double other = extracts ? 100 : 40, sampling = 10 + 5 * choice.samples;
        EXPECT_LE(sampling + other, 300) << frame;
        EXPECT_NEAR(choice.ms, sampling + other, frame < 2 ? 60 : 1e-6) << frame;
        learn(governor, choice, {sampling, other, extracts, {}});
    }
    EXPECT_NEAR(governor.extraction_ms, 60, 1e-6);
}

TEST(Governor, WhereEveryFrameExtractsTheirTimeIsLearned) {
    Governor governor = start_governor(by_time(300), {front.points, 40});
    for (int frame = 0; frame < 20; ++frame)
        learn(governor, choose(governor, true), {100, 80, true, {}});
    EXPECT_NEAR(governor.other_ms, 80, 1);
    EXPECT_EQ(governor.extraction_ms, 0);
}

TEST(Governor, APauseOfTheMachineIsNoPrice) {
    Governor governor = start_governor(by_time(200), front);
    const Choice before = choose(governor);
    learn(governor, before, {1e6, 1e6, false, {}});
    EXPECT_LT(governor.time_factor, 2);
    EXPECT_LT(governor.other_ms, 80);
}

TEST(Governor, AFrameWithoutVirtualObjectsTeachesNoPrice) {
    Governor governor = start_governor(by_time(200), front);
    learn(governor, choose(governor), {0, 40, false, {}});
    EXPECT_EQ(governor.time_factor, 1);
}

/// The first frame that sees a model gathers light for all that follow.
TEST(Governor, LightForLaterFramesIsNoPriceOfSamples) {
    OutputFrame out;
    out.ms.trace = 300;
    out.ms.filter = 20;
    out.rays.real_indirect = 1000;
    EXPECT_EQ(price_of_samples(out), 320);
    out.gathering.real_indirect = 50;
    EXPECT_EQ(price_of_samples(out), 320);
    out.gathering.real_indirect = 800;
    EXPECT_EQ(price_of_samples(out), 0);
}

}  // namespace
}  // namespace inlay
