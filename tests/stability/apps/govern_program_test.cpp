// `inlay replay` by time and by error: goals that cannot be kept, and choices made again.
#include "composite/write/frame_report.h"
#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <tuple>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::contents;
using test::file_text;
using test::Outcome;
using test::pictures;
using test::TemporaryFolder;
using test::tiny_recording;
using test::tiny_scene;
using testing::HasSubstr;

/// A run whose measured prices are kept in a folder of the test.
class Governed : public testing::Test {
protected:
    void SetUp() override { ::setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1); }

    Outcome run(const std::string& name, const std::string& options) const {
        return test::run_program("replay " + tiny_recording().string() + " --scene " +
                                 tiny_scene().string() + " --out " + (folder / name).string() +
                                 " --quiet --set slam.fusion.voxel_size=0.02"
                                 " --set slam.fusion.truncation=0.08 --poses recorded " +
                                 options);
    }

    json run_file(const std::string& name) const {
        return json::parse(file_text(folder / name / "run.json"));
    }

    TemporaryFolder folder;
};

TEST_F(Governed, ChoicesAreWrittenAndMakeTheSameBytesAgain) {
    const Outcome first = run("first", "--time-per-frame 60");
    ASSERT_EQ(first.code, 0) << first.err;
    const auto reports = read_reports(folder / "first" / "frames.jsonl");
    ASSERT_FALSE(reports.empty());
    const json choices = run_file("first")["governor"]["choices"];
    for (const FrameReport& report : reports) {
        ASSERT_TRUE(report.governor);
        EXPECT_EQ(choices[std::to_string(report.frame)], report.governor->samples);
    }
    const Outcome again = run("again", "--choices " + (folder / "first" / "run.json").string());
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_TRUE(reports.back().governor->expected_ms);
    EXPECT_EQ(pictures(folder / "first"), pictures(folder / "again"));
    EXPECT_EQ(run_file("again")["governor"]["choices"], choices);
}

TEST_F(Governed, PricesAreMeasuredOnceWhateverTheGoal) {
    ASSERT_EQ(run("first", "--error 0.05").code, 0);
    const auto kept = contents(folder / "cache");
    ASSERT_EQ(kept.size(), 2U);  // the prices, and the recording's poses
    ASSERT_EQ(run("again", "--error 0.02").code, 0);
    EXPECT_EQ(contents(folder / "cache"), kept);
}

/// The first frame that shows something is sampled with 4 and then measured.
TEST_F(Governed, ATimeThatIsTooShortTakesOneSampleAndAnErrorOfZeroTheMost) {
    for (const auto& [name, goal, samples] :
         {std::tuple{"short", "--time-per-frame 0.1", 1}, {"exact", "--error 0", 1024}}) {
        ASSERT_EQ(run(name, std::string(goal) + " --frames 0-1").code, 0);
        const auto reports = read_reports(folder / name / "frames.jsonl");
        ASSERT_EQ(reports.size(), 2U);
        ASSERT_TRUE(reports[1].governor);
        EXPECT_EQ(reports[1].governor->samples, samples);
    }
}

TEST_F(Governed, AnErrorIsEstimatedAndSaid) {
    ASSERT_EQ(run("error", "--error 0.05").code, 0);
    const auto reports = read_reports(folder / "error" / "frames.jsonl");
    ASSERT_GT(reports.size(), 1U);
    ASSERT_TRUE(reports[1].governor && reports[1].governor->estimated_error);
    EXPECT_GT(*reports[1].governor->estimated_error, 0);
    EXPECT_GT(reports[1].governor->check_ms, 0);
}

TEST_F(Governed, AResumedRunKeepsItsChoicesAndItsGoal) {
    ASSERT_EQ(run("run", "--error 0.05").code, 0);
    const json choices = run_file("run")["governor"]["choices"];
    const auto before = pictures(folder / "run");
    fs::remove(folder / "run" / "frames" / "000003.png");
    EXPECT_EQ(run("run", "--error 0.04 --resume").code, 2);
    EXPECT_EQ(run("run", "--resume").code, 2);
    ASSERT_EQ(run("run", "--error 0.05 --resume").code, 0);
    EXPECT_EQ(run_file("run")["governor"]["choices"], choices);
    EXPECT_EQ(pictures(folder / "run"), before);
}

/// Frame 2 is sampled for the temporal filter of frame 3 alone.
TEST_F(Governed, ChoicesOfSomeFramesHoldTheFrameBeforeThem) {
    ASSERT_EQ(run("some", "--error 0.05 --frames 3-4").code, 0);
    ASSERT_EQ(
        run("again", "--frames 3-4 --choices " + (folder / "some" / "run.json").string()).code, 0);
    EXPECT_EQ(pictures(folder / "some"), pictures(folder / "again"));
    EXPECT_EQ(run("other", "--choices " + (folder / "some" / "run.json").string()).code, 2);
}

TEST_F(Governed, RefusesContradictionsAndFilesWithoutChoices) {
    EXPECT_EQ(run("a", "--time-per-frame 10 --error 0.1").code, 2);
    EXPECT_EQ(run("b", "--time-per-frame -10").code, 2);
    EXPECT_EQ(run("c", "--error nan").code, 2);
    EXPECT_EQ(run("s", "--samples 8 --error 0.1").code, 2);
    EXPECT_EQ(run("d", "--choices x.json --error 0.1").code, 2);
    EXPECT_EQ(run("e", "--choices " + (folder / "none.json").string()).code, 66);
    ASSERT_EQ(run("plain", "").code, 0);
    const std::string choices = "--choices " + (folder / "plain" / "run.json").string();
    const Outcome plain = run("f", choices);
    EXPECT_EQ(plain.code, 65);
    EXPECT_THAT(plain.err, HasSubstr("expected the run.json of a run by time or by error"));
    EXPECT_EQ(run("f", "").code, 0) << "a refused file leaves nothing behind";
}

}  // namespace
}  // namespace inlay
