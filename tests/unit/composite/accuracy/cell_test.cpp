// Units become cells: repeats are spread, the best width stands, failures are kept.
#include "composite/accuracy/cell.h"

#include "composite/accuracy/unit_json.h"
#include "recordings/base/check.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

FrameError error(double mean_square) { return {mean_square, mean_square, 1, 30, 0.9, 0.1, true}; }

MethodRun run(const char* method, double width, double mean_square, int frame = 0) {
    MethodRun r;
    r.method = method;
    r.width = width;
    r.frame = frame;
    r.filter = {2, 4};
    r.composite = {1, 1};
    r.converged = error(mean_square);
    return r;
}

UnitRun unit(int repeat, double trace_ms) {
    UnitRun u{"desk", "samples", "16", repeat, 4, 4, 100, {}, {}};
    u.frames = {{0, 5, {trace_ms, 2 * trace_ms}, {1, 2, 3, 4, 5}},
                {1, 5, {trace_ms, 2 * trace_ms}, {3, 4, 5, 6, 7}}};
    for (const int frame : {0, 1})
        for (const double width : {1.0, 2.0, 4.0})
            u.runs.push_back(run("blur", width, width == 2 ? 0.01 : 0.04, frame));
    return u;
}

TEST(Spread, IsMedianAndRange) {
    EXPECT_EQ(spread_of({3, 1, 2}).median, 2);
    EXPECT_EQ(spread_of({4, 1, 2, 3}).median, 2.5);
    EXPECT_EQ(spread_of({4, 1}).min, 1);
    EXPECT_EQ(spread_of({4, 1}).max, 4);
    EXPECT_EQ(spread_of({}).median, 0);
}

TEST(Cells, TheWidthWithTheLeastErrorStands) {
    const auto cells = cells_of({unit(0, 10)});
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_EQ(cells[0].width, 2.0);
    EXPECT_NEAR(*cells[0].converged->rmse_influenced, 0.1, 1e-12);
    EXPECT_EQ(cells[0].id, "samples=16/blur");
}

TEST(Cells, RepeatsAreSpreadOverMeansOfFrames) {
    const auto cells = cells_of({unit(1, 30), unit(0, 10), unit(2, 20)});
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_EQ(cells[0].wall.trace.median, 20);
    EXPECT_EQ(cells[0].wall.trace.max, 30);
    EXPECT_EQ(cells[0].wall.total.min, 13);
    EXPECT_EQ(cells[0].cpu.trace.median, 40);
    EXPECT_EQ(cells[0].rays.primary, 2u);
    EXPECT_EQ(cells[0].frames.size(), 2u);
    EXPECT_EQ(cells[0].frames[1].ms, 23);
}

TEST(Cells, MeanSquaresAreAveragedBeforeTheRoot) {
    UnitRun u = unit(0, 1);
    u.runs = {run("blur", 1, 0.01, 0), run("blur", 1, 0.03, 1)};
    EXPECT_NEAR(cells_of({u})[0].converged->rmse, std::sqrt(0.02), 1e-12);
}

TEST(Cells, AFrameWithoutInfluencedPixelsDoesNotThinTheOthers) {
    UnitRun u = unit(0, 1);
    u.runs = {run("blur", 1, 0.01, 0), run("blur", 1, 0, 1)};
    u.runs[1].converged->influenced = false;
    EXPECT_NEAR(*cells_of({u})[0].converged->rmse_influenced, 0.1, 1e-12);
    u.runs[0].converged->influenced = false;
    EXPECT_FALSE(cells_of({u})[0].converged->rmse_influenced);
}

TEST(Cells, AFailureKeepsItsMessageAndHasNoFigures) {
    UnitRun u = unit(0, 1);
    u.runs = {run("blur", 1, 0.01)};
    u.runs[0].converged.reset();
    u.runs[0].failed = "no such luck";
    const auto cells = cells_of({u});
    EXPECT_EQ(cells[0].failed, "no such luck");
    EXPECT_FALSE(cells[0].converged);
}

TEST(Cells, AFailureInALaterRepeatIsSaidAndInNoFigure) {
    std::vector<UnitRun> units{unit(0, 10), unit(1, 20), unit(2, 30)};
    for (MethodRun& r : units[1].runs) {
        if (r.frame != 1) continue;  // the other frame's run is sound
        r.failed = "out of luck";
        r.filter = r.composite = {};
        r.converged.reset();
    }
    const auto cells = cells_of(units);
    ASSERT_EQ(cells.size(), 1u);
    EXPECT_EQ(cells[0].failed, "");
    ASSERT_EQ(cells[0].failed_repeats.size(), 1u);
    EXPECT_EQ(cells[0].failed_repeats[0].repeat, 1);
    EXPECT_EQ(cells[0].failed_repeats[0].message, "out of luck");
    EXPECT_EQ(cells[0].wall.trace.median, 20);  // of 10 and 30
    EXPECT_EQ(cells[0].wall.trace.min, 10);
    EXPECT_EQ(cells[0].wall.filter.min, 2);
    EXPECT_EQ(cells[0].wall.total.median, 23);
    EXPECT_EQ(cells[0].frames[1].ms, 23);
    EXPECT_NEAR(*cells[0].converged->rmse_influenced, 0.1, 1e-12);
}

TEST(UnitJson, ComesBackAsItWas) {
    UnitRun u = unit(2, 1.0 / 3);
    u.runs[0].truth = error(0.25);
    u.runs[1].flicker = 0.125;
    u.runs[2].failed = "a \"quoted\" message";
    const UnitRun back = unit_from_json(to_json_text(u), "test");
    EXPECT_EQ(to_json_text(back), to_json_text(u));
    EXPECT_EQ(back.frames[0].trace.wall_ms, 1.0 / 3);
    EXPECT_EQ(back.runs[2].failed, u.runs[2].failed);
    EXPECT_FALSE(back.runs[0].flicker);
}

TEST(UnitJson, ACutOffFileIsRefusedByName) {
    const std::string text = to_json_text(unit(0, 1));
    try {
        unit_from_json(text.substr(0, text.size() / 2), "units/a.json");
        FAIL() << "half a file was accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::bad_data);
        EXPECT_NE(std::string(e.what()).find("units/a.json"), std::string::npos);
    }
}

}  // namespace
}  // namespace inlay
