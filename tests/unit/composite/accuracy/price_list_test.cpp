// Fronts, and methods compared at equal error and at equal time.
#include "composite/accuracy/price_list.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

PricedPoint point(double ms, double error, int samples = 1) {
    return {ms, error, 2 * error, samples, std::to_string(samples)};
}

/// Monte Carlo: error 1 / sqrt(samples), a millisecond a sample.
std::vector<PricedPoint> monte_carlo() {
    std::vector<PricedPoint> points;
    for (const int n : {1, 4, 16, 64})
        points.push_back(point(n, 1 / std::sqrt(n), n));
    return points;
}

TEST(ParetoFront, KeepsWhatNothingElseBeats) {
    const auto front = pareto_front({point(4, 0.5, 4), point(1, 1, 1), point(2, 1.5, 2),
                                     point(4, 0.6, 5), point(8, 0.5, 8), point(9, 0.1, 9)});
    ASSERT_EQ(front.size(), 3u);
    EXPECT_EQ(front[0].id, "1");
    EXPECT_EQ(front[1].id, "4");  // the cheaper of two with one error
    EXPECT_EQ(front[2].id, "9");
}

TEST(ParetoFront, OfNothingIsNothing) { EXPECT_TRUE(pareto_front({}).empty()); }

TEST(AtError, InterpolatesAPowerLawExactly) {
    // Between 4 and 16 samples the law holds at 9 too, since it is straight on log axes.
    const auto place = at_error(monte_carlo(), 1.0 / 3);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->ms, 9, 1e-9);
    EXPECT_NEAR(place->samples, 9, 1e-9);
    EXPECT_NEAR(place->flip, 2.0 / 3, 1e-9);
    EXPECT_FALSE(place->beyond);
}

TEST(AtError, TakesTheFirstPointWhereItIsGoodEnough) {
    EXPECT_EQ(at_error(monte_carlo(), 2)->ms, 1);
}

TEST(AtError, SaysWhereTheFrontEndsBefore) {
    const auto place = at_error(monte_carlo(), 0.01);
    EXPECT_TRUE(place->beyond);
    EXPECT_EQ(place->ms, 64);
    EXPECT_FALSE(at_error({}, 1));
}

TEST(AtTime, InterpolatesAPowerLawExactly) {
    const auto place = at_time(monte_carlo(), 9);
    ASSERT_TRUE(place);
    EXPECT_NEAR(place->error, 1.0 / 3, 1e-9);
    EXPECT_FALSE(at_time(monte_carlo(), 0.5));
    EXPECT_TRUE(at_time(monte_carlo(), 100)->beyond);
    EXPECT_FALSE(at_time(monte_carlo(), 64)->beyond);
}

Cell cell(const char* method, int samples, double ms, double rmse) {
    Cell c;
    c.method = method;
    c.knob = "samples";
    c.value = std::to_string(samples);
    c.id = c.value + method;
    c.primary = 1;
    c.secondary = samples;
    c.wall.total = {ms, ms, ms};
    c.converged = CellError{rmse, rmse, rmse, 30, 1, rmse};
    return c;
}

std::vector<Cell> a_filter_and_monte_carlo() {
    std::vector<Cell> cells;
    for (const PricedPoint& p : monte_carlo())
        cells.push_back(cell("unfiltered", p.samples, p.ms, p.error));
    cells.push_back(cell("difference", 16, 18, 0.125));
    return cells;
}

TEST(PriceList, SpeedUpIsTheUnfilteredTimeOverTheFilteredOne) {
    const PriceList list = price_list(a_filter_and_monte_carlo());
    ASSERT_EQ(list.equal_error.size(), 1u);
    EXPECT_NEAR(list.equal_error[0].unfiltered_ms, 64, 1e-9);
    EXPECT_NEAR(list.equal_error[0].speed_up, 64.0 / 18, 1e-9);
    EXPECT_FALSE(list.equal_error[0].beyond);
}

TEST(PriceList, ComparesMethodsAtTheAnchorsTime) {
    const PriceList list = price_list(a_filter_and_monte_carlo());
    ASSERT_EQ(list.equal_time.size(), 2u);
    EXPECT_EQ(list.equal_time[0].method, "unfiltered");
    EXPECT_NEAR(list.equal_time[0].rmse, 1 / std::sqrt(18), 1e-9);
    EXPECT_NEAR(list.equal_time[0].rmse_ratio, 8 / std::sqrt(18), 1e-9);
    EXPECT_NEAR(list.equal_time[1].rmse_ratio, 1, 1e-12);
}

TEST(PriceList, LeavesOutWhatFailedOrHasNoInfluencedPixel) {
    std::vector<Cell> cells = a_filter_and_monte_carlo();
    cells[1].failed = "out of luck";
    cells[2].converged->rmse_influenced.reset();
    EXPECT_EQ(price_list(cells).rmse_front,
              (std::vector<std::string>{"1unfiltered", "16difference"}));
    EXPECT_TRUE(price_list({}).rmse_front.empty());
}

}  // namespace
}  // namespace inlay
