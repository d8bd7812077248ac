// A unit hands the same samples to every method; one that throws does not stop the others.
#include "composite/accuracy/unit.h"

#include "composite/accuracy/cell.h"
#include "composite/accuracy/judged_frames.h"
#include "composite/accuracy/unit_json.h"
#include "recordings/base/check.h"
#include "tests/support/tabletop.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

/// A still view of a table with two virtual balls.
Work tabletop_work() {
    Work work;
    work.name = "tabletop";
    work.scene = test::tabletop();
    const VirtualScene balls = test::two_virtual_balls();
    work.scene.objects.insert(work.scene.objects.end(), balls.objects.begin(), balls.objects.end());
    work.knows_room = true;
    work.environment = make_environment_sampler(test::soft_light());
    work.view = View{{24, 18, 22, 22, 11.5, 8.5}, test::camera_around(0.0), {0, 1, 0}};
    return work;
}

Layers fail_with_previous(const MethodInput& in) {
    if (in.previous != nullptr) throw Error(ExitCode::bad_data, "no room for a previous frame");
    return method_named("unfiltered").apply(in);
}

Layers fail_with_another_exception(const MethodInput&) { throw std::bad_alloc(); }

UnitRun measured() {
    static const Method picky{"picky", "Picky", "baseline", "", {}, fail_with_previous};
    static const Method greedy{"greedy", "Greedy", "baseline", "", {}, fail_with_another_exception};
    const Work work = tabletop_work();
    UnitPlan plan;
    plan.knob = "samples";
    plan.value = "4";
    plan.settings.trace = with_samples(plan.settings.trace, 4);
    plan.cells = {{&method_named("unfiltered"), false, 0},
                  {&greedy, false, 0},
                  {&picky, false, 0},
                  {&picky, true, 0},
                  {&method_named("axis_aligned"), true, 0}};
    return measure_unit(work, judge_frames(work, {0}, {plan.settings}, 8), plan);
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

}  // namespace
}  // namespace inlay
