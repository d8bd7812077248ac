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
            "slam.fusion.voxel_size=0.02",
            "--set",
            "slam.fusion.truncation=0.08",
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

TEST(Resume, TakesAFolderForTheSameHoweverItsPathIsWritten) {
    const TemporaryFolder folder;
    fs::copy(uninterrupted(), folder / "out", fs::copy_options::recursive);
    for (const char* written : {"/", "/.", "/rgb/.."}) {
        const Outcome outcome = replay(tiny_recording().string() + written, tiny_scene(),
                                       folder / "out", slow + "--resume");
        EXPECT_EQ(outcome.code, 0) << written << ": " << outcome.err;
    }
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
    expect_refused(tiny_scene(), slow + "--resume --seed 2", 2,
                   "settings trace.seed was \"1\" and is \"2\"");
    expect_refused(tiny_scene(), slow + "--resume --layers M", 2, "other layers");
    expect_refused(edited, slow + "--resume --assets " + tiny_recording().string(), 2,
                   "other scene");
    EXPECT_TRUE(contents(uninterrupted()) == before);
}

/// A folder with a textured mesh in it, and the run of frame 0 with it.
void make_run_with_assets(const TemporaryFolder& folder, const std::string& scene) {
    const fs::path assets = folder / "assets";
    test::write_file(folder / "scene.json", scene);
    test::write_file(assets / "plate/plate.obj",
                     "mtllib plate.mtl\nv 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                     "usemtl m\nf 1/1 2/2 3/3\n");
    test::write_file(assets / "plate/plate.mtl", "newmtl m\nKd 0.5 0.5 0.5\nmap_Kd plate.png\n");
    test::write_color(assets / "plate/plate.png", 8, 8);
}

TEST(Resume, NamesWhatDiffers) {
    const TemporaryFolder folder;
    make_run_with_assets(folder,
                         R"({"version": 1, "environment": {"constant": [1, 1, 1]}, "objects": [
        {"name": "plate", "mesh": "plate/plate.obj",
         "transform": [1,0,0,0, 0,1,0,0.05, 0,0,1,0, 0,0,0,1]}]})");
    const fs::path recording = test::copy_of_recording(folder);
    const auto run = [&](const std::string& options) {
        return replay(recording, folder / "scene.json", folder / "out",
                      "--frames 0 --assets " + (folder / "assets").string() + " " + options);
    };
    const Outcome first = run("");
    ASSERT_EQ(first.code, 0) << first.err;
    const auto expect_refused = [&](const std::string& options, const std::string& what) {
        const Outcome outcome = run("--resume " + options);
        EXPECT_EQ(outcome.code, 2) << options;
        EXPECT_THAT(outcome.err, testing::AllOf(HasSubstr("run.json"), HasSubstr(what)));
    };
    expect_refused("--max-depth 3", "recording max_depth_m was 0.0 and is 3.0");
    expect_refused("--poses recorded", "settings slam.poses was \"tracked\" and is \"recorded\"");
    expect_refused("--slam fast", "settings slam.half_resolution was \"off\" and is \"on\"");
    const auto expect_refused_when_changed = [&](const fs::path& file, const std::string& text,
                                                 const std::string& what) {
        const std::string before = test::file_text(file);
        test::write_file(file, text);
        expect_refused("", what);
        test::write_file(file, before);
    };
    const fs::path plate = folder / "assets/plate";
    const std::string mesh = test::file_text(plate / "plate.obj");
    expect_refused_when_changed(plate / "plate.obj", mesh + "\n", "scene files plate/plate.obj");
    expect_refused_when_changed(plate / "plate.mtl", test::file_text(plate / "plate.mtl") + "\n",
                                "scene files plate/plate.mtl");
    expect_refused_when_changed(plate / "plate.png", test::file_text(plate / "plate.png") + "x",
                                "scene files plate/plate.png");
    std::string camera = test::file_text(recording / "camera.json");
    camera.replace(camera.find("\"up\""), std::string::npos, "\"up\": [0, 0, 1]}");
    expect_refused_when_changed(recording / "camera.json", camera, "recording up was");
    expect_refused_when_changed(recording / "groundtruth.txt",
                                "0.0 0 0 0 0 0 0 1\n0.2 0 0 0 0 0 0 1\n", "recording fingerprint");
    const Outcome same = run("--resume --threads 1");
    EXPECT_EQ(same.code, 0) << same.err;
}

}  // namespace
}  // namespace inlay
