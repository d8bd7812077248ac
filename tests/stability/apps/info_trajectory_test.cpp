// `inlay info --trajectory`: known errors between two files, and files that cannot be compared.
#include "tests/support/program_runs.h"
#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <functional>

namespace inlay::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// 40 poses at 20 a second on a circle, looking along z; `off` (m) is added to each x.
void write_circle(const std::filesystem::path& file, const std::function<double(int)>& off,
                  double start = 0) {
    std::ofstream out(file);
    out.precision(15);
    for (int i = 0; i < 40; ++i)
        out << start + 0.05 * i << ' ' << std::cos(0.1 * i) + off(i) << ' ' << std::sin(0.1 * i)
            << " 0 0 0 0 1\n";
}

TEST(InfoTrajectory, FindsTheErrorsThatWerePutIn) {
    TemporaryFolder folder;
    write_circle(folder / "true.txt", [](int) { return 0.0; });
    write_circle(
        folder / "zigzag.txt", [](int i) { return i % 2 == 0 ? 0.01 : -0.01; }, 0.004);
    const Outcome outcome = run_program("info --trajectory " + (folder / "zigzag.txt").string() +
                                        " " + (folder / "true.txt").string() + " --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json found = json::parse(outcome.out);
    EXPECT_EQ(found["paired"], 40);
    EXPECT_EQ(found["unpaired"], 0);
    // each pose is 1 cm off; the alignment takes out what of that looks like a motion, below 1 %
    EXPECT_NEAR(found["absolute"]["rms_m"], 0.01, 1e-4);
    EXPECT_NEAR(found["relative_per_frame"]["rms_m"], 0.02, 1e-9);  // from +1 cm to -1 cm
    EXPECT_NEAR(found["relative_per_second"]["rms_m"], 0, 1e-9);    // 20 frames on: the same side
    EXPECT_NEAR(found["absolute"]["rms_deg"], 0, 0.1);
}

TEST(InfoTrajectory, ARigidMotionOfTheWholeIsNoAbsoluteError) {
    TemporaryFolder folder;
    write_circle(folder / "true.txt", [](int) { return 0.0; });
    write_circle(folder / "moved.txt", [](int) { return 5.0; });
    const Outcome outcome = run_program("info --trajectory " + (folder / "moved.txt").string() +
                                        " " + (folder / "true.txt").string());
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("40 poses paired, 0 without a partner"));
    EXPECT_THAT(outcome.out, HasSubstr("rms 0.00 mm"));
}

TEST(InfoTrajectory, SaysWhatCannotBeCompared) {
    TemporaryFolder folder;
    write_circle(folder / "a.txt", [](int) { return 0.0; });
    write_circle(
        folder / "later.txt", [](int) { return 0.0; }, 1000);
    const std::string a = (folder / "a.txt").string();
    const Outcome apart =
        run_program("info --trajectory " + a + " " + (folder / "later.txt").string());
    EXPECT_EQ(apart.code, 65);
    EXPECT_THAT(apart.err, HasSubstr("the same clock"));
    EXPECT_EQ(run_program("info --trajectory " + a + " " + (folder / "none.txt").string()).code,
              66);
    EXPECT_EQ(run_program("info --trajectory " + a).code, 2);
}

}  // namespace
}  // namespace inlay::test
