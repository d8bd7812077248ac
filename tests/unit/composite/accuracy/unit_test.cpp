// A unit hands the same samples to every method; one that throws does not stop the others.
#include "composite/accuracy/unit.h"

#include "composite/accuracy/cell.h"
#include "composite/accuracy/judged_frames.h"
#include "composite/accuracy/unit_json.h"
#include "recordings/base/check.h"
#include "tests/support/tabletop_work.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

Layers fail_with_previous(const MethodInput& in) {
    if (in.previous != nullptr) throw Error(ExitCode::bad_data, "no room for a previous frame");
    return method_named("unfiltered").apply(in);
}

Layers fail_with_another_exception(const MethodInput&) { throw std::bad_alloc(); }

UnitRun measured() {
    static const Method picky{"picky", "Picky", "baseline", "", {}, fail_with_previous};
    static const Method greedy{"greedy", "Greedy", "baseline", "", {}, fail_with_another_exception};
    const Work work = test::tabletop_work();
    UnitPlan plan;
    plan.knob = "samples";
    plan.value = "4";
    plan.settings.trace = with_samples(plan.settings.trace, 4);
    plan.cells = {{&method_named("unfiltered"), false, 0},
                  {&greedy, false, 0},
                  {&picky, false, 0},
                  {&picky, true, 0},
                  {&method_named("axis_aligned"), true, 0}};
    return measure_unit(work, judge_frames(work, {0}, {plan.settings}, 128), plan);
}

TEST(MeasureUnit, GoesOnAfterAMethodThatFails) {
    const UnitRun unit = measured();
    ASSERT_EQ(unit.runs.size(), 5u);
    for (const std::size_t good : {0u, 2u, 4u}) {
        EXPECT_EQ(unit.runs[good].failed, "");
        ASSERT_TRUE(unit.runs[good].converged.has_value());
        EXPECT_GT(unit.runs[good].converged->mean_square, 0) << good;
    }
    EXPECT_EQ(unit.runs[1].failed, std::bad_alloc().what());
    EXPECT_EQ(unit.runs[3].failed, "no room for a previous frame");
    EXPECT_FALSE(unit.runs[3].converged.has_value());
    // the same samples and the same method give the same error, whatever failed in between
    EXPECT_EQ(unit.runs[0].converged->mean_square, unit.runs[2].converged->mean_square);
}

TEST(MeasureUnit, AFailureIsKeptAndBecomesACellWithoutFigures) {
    const UnitRun unit = measured();
    const UnitRun again = unit_from_json(to_json_text(unit), "unit");
    const std::vector<Cell> cells = cells_of({again});
    ASSERT_EQ(cells.size(), 5u);
    EXPECT_EQ(cells[3].id, "samples=4/picky/temporal");
    EXPECT_EQ(cells[3].failed, "no room for a previous frame");
    EXPECT_FALSE(cells[3].converged.has_value());
    EXPECT_EQ(cells[2].failed, "");
    EXPECT_TRUE(cells[4].converged.has_value());
}

TEST(MeasureUnit, MeasuresAllCellsOnTheSameFrames) {
    const Work work = test::tabletop_work();
    std::vector<JudgedFrame> frames = judge_frames(work, {0}, {Settings{}}, 8);
    frames.push_back(frames.front());
    frames.push_back(frames.front());
    frames[1].now.frame = 1;
    frames[2].now.frame = 2;
    frames[1].previous.reset();
    UnitPlan plan;
    plan.settings.trace = with_samples(plan.settings.trace, 4);
    plan.cells = {{&method_named("axis_aligned"), false, 0},
                  {&method_named("axis_aligned"), true, 0}};
    const UnitRun unit = measure_unit(work, frames, plan);
    ASSERT_EQ(unit.frames.size(), 2u);  // frame 1 is measured with no method
    ASSERT_EQ(unit.runs.size(), 4u);
    for (const MethodRun& run : unit.runs)
        EXPECT_NE(run.frame, 1);
    for (JudgedFrame& frame : frames)
        frame.previous.reset();
    const UnitRun alone = measure_unit(work, frames, plan);
    EXPECT_EQ(alone.frames.size(), 3u);
    ASSERT_EQ(alone.runs.size(), 3u);
    for (const MethodRun& run : alone.runs)
        EXPECT_FALSE(run.temporal);
}

}  // namespace
}  // namespace inlay
