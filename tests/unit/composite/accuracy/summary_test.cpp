// The summary says what the price list says, and a dash where it says nothing.
#include "composite/accuracy/summary.h"

#include <gmock/gmock.h>

#include <cmath>

namespace inlay {
namespace {

using testing::HasSubstr;
using testing::Not;

Cell cell(const char* method, int samples, std::optional<double> rmse, double ms) {
    Cell c;
    c.knob = "samples";
    c.value = std::to_string(samples);
    c.method = method;
    c.id = "samples=" + c.value + "/" + method;
    c.primary = samples;
    c.secondary = 1;
    c.wall.total = {ms, ms, ms};
    c.converged = CellError{0.1, rmse, 0.1, 30, 0.9, 0.02};
    return c;
}

/// Noise of 0.08 / sqrt(samples) unfiltered, a quarter of it filtered; 1 ms a sample.
AccuracyReport report() {
    AccuracyReport r;
    r.program = "1.2.3";
    r.date = "2026-01-31T12:00:00Z";
    r.machine.cpu = "Abacus";
    r.machine.threads = 2;
    r.repeats = 3;
    WorkReport work;
    work.name = "desk";
    work.kind = "recording";
    work.frames = {5, 11};
    for (const int samples : {4, 16, 64, 256}) {
        const double noise = 0.08 / std::sqrt(samples);
        work.cells.push_back(cell("unfiltered", samples, noise, samples));
        work.cells.push_back(cell("difference", samples, noise / 4, samples + 4));
    }
    r.works.push_back(work);
    return r;
}

TEST(Summary, SaysWhatWasMeasuredWhenAndWhere) {
    const std::string text = summary_text(report());
    EXPECT_THAT(text, HasSubstr("1.2.3, 2026-01-31, on Abacus, threads 2; repeats 3, seed 1."));
    EXPECT_THAT(text, HasSubstr("## desk"));
    EXPECT_THAT(text, HasSubstr("frames 5, 11"));
    // 16 samples filtered have a quarter of the noise, as 16 times the samples have
    EXPECT_THAT(text, HasSubstr("| desk | Difference form | 0.0050 | 20.0 | 256.0 | 256 | "
                                "12.8 | 1.00 |\n"));
    EXPECT_THAT(text, HasSubstr("| desk | Difference form | 0.0100 at 4, 0.0050 at 16, "
                                "0.0025 at 64, 0.0013 at 256 | -0.50 |\n"));
}

TEST(Summary, MarksWhatIsOnlyABound) {
    AccuracyReport r = report();
    std::erase_if(r.works[0].cells, [](const Cell& c) { return c.value == "256"; });
    EXPECT_THAT(summary_text(r), HasSubstr("| 0.0050 | 20.0 | > 64.0 | > 64 | > 3.2 | 1.00 |"));
}

TEST(Summary, HasBlameAndFailures) {
    AccuracyReport r = report();
    FrameBlame blame;
    blame.frame = 5;
    blame.rmse = 0.03;
    blame.photograph_rmse = 0.2;
    blame.best_rmse = NAN;
    blame.culprit = Stage::geometry;
    for (const Stage stage : all_stages)
        blame.stages.push_back({stage, 0.01, stage == Stage::geometry ? 0.75 : -0.01});
    r.works[0].blame = {blame};
    r.works[0].cells.back().failed = "it was too dark";
    const std::string text = summary_text(r);
    EXPECT_THAT(text, HasSubstr("| desk | 5 | 0.0300 | 0.2000 | - | geometry | -1 % | 75 % | -1 % "
                                "| -1 % | -1 % |\n"));
    EXPECT_THAT(text, HasSubstr("- failed: samples=256/difference: it was too dark\n"));
}

TEST(Summary, PutsBudgetsBesideErrors) {
    AccuracyReport r = report();
    FrameVerdict verdict;
    verdict.frame = 5;
    verdict.rmse = 0.03;
    verdict.budget.total = 0.05;
    verdict.light = {0.1, 0.2, 1};
    verdict.budget.e_r = 0.15;
    verdict.budget.e_rv = 0.15;
    verdict.flicker = 0.01;
    verdict.budget.flicker = 0.02;
    r.works[0].verdicts = {verdict};
    const std::string text = summary_text(r);
    EXPECT_THAT(text, HasSubstr("\nBudget: "));
    EXPECT_THAT(text, HasSubstr("| work | frame | RMSE | E_R | E_RV | flicker |\n"));
    EXPECT_THAT(text, HasSubstr("| desk | 5 | 0.0300 of 0.0500 | 0.1000 of 0.1500 | 0.2000 of "
                                "0.1500 (over) | 0.0100 of 0.0200 |\n"));
}

TEST(Summary, SaysWhichRepeatFailed) {
    AccuracyReport r = report();
    r.works[0].cells.back().failed_repeats = {{2, "it was too dark"}};
    EXPECT_THAT(summary_text(r), HasSubstr("- failed in repeat 3: samples=256/difference: it was "
                                           "too dark\n"));
}

TEST(Summary, HasNoTableWithoutFigures) {
    AccuracyReport r = report();
    for (Cell& c : r.works[0].cells)
        c.converged->rmse_influenced = std::nullopt;
    const std::string text = summary_text(r);
    EXPECT_THAT(text, HasSubstr("## desk"));
    EXPECT_THAT(text, Not(HasSubstr("|")));
}

TEST(ErrorSlope, IsThePowerOfThePowerLaw) {
    std::vector<Cell> cells;
    for (const int samples : {1, 4, 16, 64})
        cells.push_back(cell("a", samples, 0.3 * std::pow(samples, -0.37), 1));
    EXPECT_NEAR(*error_slope(cells, "a", false), -0.37, 1e-12);  // rounding
    EXPECT_FALSE(error_slope(cells, "a", true).has_value());
    EXPECT_FALSE(error_slope({cells[0]}, "a", false).has_value());
    EXPECT_FALSE(error_slope({cells[0], cells[0]}, "a", false).has_value());
    cells[0].converged->rmse_influenced = 0;  // has no logarithm
    EXPECT_NEAR(*error_slope(cells, "a", false), -0.37, 1e-12);
}

}  // namespace
}  // namespace inlay
