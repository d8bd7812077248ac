// Interrupted runs of `inlay replay`: what was finished stays, and resuming gives what an
// uninterrupted run would have given.
#include "composite/write/frame_report.h"
#include "tests/support/program_runs.h"

#include <signal.h>

#include <chrono>
#include <thread>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::contents;
using test::Outcome;
using test::pictures;
using test::replay;
using test::TemporaryFolder;
using test::tiny_recording;
using test::tiny_scene;
using testing::HasSubstr;
using testing::SizeIs;

/// More samples than elsewhere, so that a frame takes long enough to be interrupted.
const std::string slow = "--poses recorded --set trace.secondary=8 ";

std::vector<std::string> slow_replay(const fs::path& out) {
    return {"replay",
            tiny_recording().string(),
            "--scene",
            tiny_scene().string(),
            "--out",
            out.string(),
            "--quiet",
            "--samples",
            "4",
            "--set",
            "slam.voxel_size=0.02",
            "--set",
            "slam.truncation=0.08",
            "--poses",
            "recorded",
            "--set",
            "trace.secondary=8"};
}

const fs::path& uninterrupted() {
    static const TemporaryFolder folder;
    static const fs::path run = [] {
        const Outcome outcome = replay(tiny_recording(), tiny_scene(), folder / "out", slow);
        if (outcome.code != 0) throw std::runtime_error("cannot replay: " + outcome.err);
        return folder / "out";
    }();
    return run;
}

/// Ends the program with `signal` when it has finished its first frame; returns waitpid's status.
int end_after_first_frame(const fs::path& out, int signal) {
    const pid_t process = test::start_program(slow_replay(out));
    int status = 0;
    while (read_reports(out / "frames.jsonl").empty() && ::waitpid(process, &status, WNOHANG) == 0)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ::kill(process, signal);
    ::waitpid(process, &status, 0);
    return status;
}

/// Every file under a final name is one of the whole run; there is at least one, and one is
/// missing.
void expect_complete_files(const fs::path& run) {
    const auto some = pictures(run), all = pictures(uninterrupted());
    int complete = 0;
    for (const auto& [name, bytes] : some) {
        if (fs::path(name).filename().string().starts_with(".")) continue;  // not its final name
        EXPECT_TRUE(all.at(name) == bytes) << name;
        ++complete;
    }
    EXPECT_GE(complete, 2);
    EXPECT_LT(complete, 12);
}

void expect_resumed_as_uninterrupted(const fs::path& run) {
    const Outcome outcome = replay(tiny_recording(), tiny_scene(), run, slow + "--resume");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(pictures(run) == pictures(uninterrupted()));
    std::set<int> frames;
    for (const FrameReport& report : read_reports(run / "frames.jsonl"))
        EXPECT_TRUE(frames.insert(report.frame).second) << report.frame << " has two lines";
    EXPECT_THAT(frames, SizeIs(6));
}

TEST(Resume, GoesOnAfterAnInterrupt) {
    const TemporaryFolder folder;
    const int status = end_after_first_frame(folder / "out", SIGINT);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 130);
    expect_complete_files(folder / "out");
    expect_resumed_as_uninterrupted(folder / "out");
}

TEST(Resume, GoesOnAfterAKill) {
    const TemporaryFolder folder;
    ASSERT_TRUE(WIFSIGNALED(end_after_first_frame(folder / "out", SIGKILL)));
    expect_complete_files(folder / "out");
    expect_resumed_as_uninterrupted(folder / "out");
}

TEST(Resume, MakesAgainWhatWasRemoved) {
    const TemporaryFolder folder;
    fs::copy(uninterrupted(), folder / "out", fs::copy_options::recursive);
    fs::remove(folder / "out/frames/000004.png");
    expect_resumed_as_uninterrupted(folder / "out");
}

TEST(Resume, RefusesAnotherRun) {
    const auto before = contents(uninterrupted());
    const TemporaryFolder folder;
    const fs::path edited = folder / "scene.json";
    test::write_file(edited, test::file_text(tiny_scene()) + "\n");
    const auto expect_refused = [&](const fs::path& scene, const std::string& options, int code,
                                    const std::string& message) {
        const Outcome outcome = replay(tiny_recording(), scene, uninterrupted(), options);
        EXPECT_EQ(outcome.code, code) << options;
        EXPECT_THAT(outcome.err, HasSubstr(message));
    };
    expect_refused(tiny_scene(), slow, 73, "--resume");
    expect_refused(tiny_scene(), slow + "--resume --seed 2", 2, "other settings");
    expect_refused(tiny_scene(), slow + "--resume --layers M", 2, "other layers");
    expect_refused(edited, slow + "--resume --assets " + tiny_recording().string(), 2,
                   "other scene");
    EXPECT_TRUE(contents(uninterrupted()) == before);
}

}  // namespace
}  // namespace inlay
