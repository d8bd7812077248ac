// `inlay replay` of damaged recordings: the exit code and message that fit, and what was finished
// before the damage stays.
#include "composite/write/frame_report.h"
#include "recordings/readers/trajectory.h"
#include "tests/support/program_runs.h"

#include <algorithm>
#include <sstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::file_text;
using test::Outcome;
using test::replay;
using test::run_program;
using test::TemporaryFolder;
using test::tiny_scene;
using test::write_file;
using testing::AllOf;
using testing::HasSubstr;
using testing::SizeIs;

/// A damaged recording is replayed; the result lies beside it.
class DamagedRecording : public testing::Test {
protected:
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder);
    const fs::path out = folder / "out";

    Outcome play(const std::string& options = "") {
        return replay(recording, tiny_scene(), out, options);
    }
    void cut(const std::string& name) {
        fs::resize_file(recording / name, fs::file_size(recording / name) / 2);
    }
    /// Replaces fields `first` and beyond of a row of a list (from 0, the comment included).
    void replace_row(const std::string& name, int row, int first, const std::string& fields) {
        std::istringstream text(file_text(recording / name));
        std::string changed;
        int number = 0;
        for (std::string line; std::getline(text, line); ++number) {
            std::size_t end = 0;
            for (int field = 0; field < first; ++field)
                end = line.find(' ', end) + 1;
            changed += (number == row ? line.substr(0, end) + fields : line) + "\n";
        }
        write_file(recording / name, changed);
    }
    void expect_refused(const std::string& file, const std::string& words, int finished) {
        const Outcome outcome = play();
        EXPECT_EQ(outcome.code, 65);
        EXPECT_THAT(outcome.err, AllOf(HasSubstr(file), HasSubstr(words)));
        EXPECT_THAT(test::pictures(out), SizeIs(2 * finished));  // a PNG and an EXR each
        EXPECT_THAT(file_text(out / "frames.jsonl"),
                    testing::ResultOf(
                        [](const std::string& s) { return std::count(s.begin(), s.end(), '\n'); },
                        finished));
    }
};

TEST_F(DamagedRecording, CutOffColor) {
    cut("rgb/000003.png");
    expect_refused("rgb/000003.png", "damaged or cut off", 3);
}

TEST_F(DamagedRecording, CutOffDepth) {
    cut("depth/000003.png");
    expect_refused("depth/000003.png", "damaged or cut off", 3);
}

TEST_F(DamagedRecording, DepthOfEightBits) {
    test::write_image(recording / "depth/000002.png", cv::Mat(72, 96, CV_8UC1, cv::Scalar(200)));
    expect_refused("depth/000002.png", "8-bit", 2);
}

TEST_F(DamagedRecording, DepthAsJpeg) {
    test::write_image(folder / "depth.jpg", cv::Mat(72, 96, CV_8UC1, cv::Scalar(200)));
    fs::rename(folder / "depth.jpg", recording / "depth/000002.png");
    expect_refused("depth/000002.png", "JPEG", 2);
}

TEST_F(DamagedRecording, SizesThatChange) {
    test::write_color(recording / "rgb/000002.png", 64, 48);
    expect_refused("rgb/000002.png", "96", 2);
}

TEST_F(DamagedRecording, AMissingFileLeavesOutItsFrame) {
    fs::remove(recording / "rgb/000003.png");
    const Outcome outcome = run_program("replay " + recording.string() + " --scene " +
                                        tiny_scene().string() + " --out " + out.string() +
                                        " --samples 4 --set slam.fusion.voxel_size=0.02"
                                        " --set slam.fusion.truncation=0.08");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("rgb/000003.png"));
    EXPECT_THAT(test::pictures(out), SizeIs(10));
    EXPECT_FALSE(fs::exists(out / "frames/000003.png"));
}

TEST_F(DamagedRecording, ListsThatDoNotMatch) {
    std::string list = "# half a second late\n";
    for (int i = 0; i < 6; ++i)
        list += std::to_string(0.5 + i / 30.0) + " depth/00000" + std::to_string(i) + ".png\n";
    write_file(recording / "depth.txt", list);
    const Outcome outcome = play();
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, HasSubstr("no frame with both a color and a depth image"));
    EXPECT_FALSE(fs::exists(out));
}

TEST_F(DamagedRecording, ARowThatIsNone) {
    replace_row("rgb.txt", 3, 0, "soon rgb/000002.png");
    const Outcome outcome = play();
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("rgb.txt"), HasSubstr("4"), HasSubstr("soon")));
}

/// A frame with an unusable pose is tracked like any other; its neighbors' poses stay the recorded
/// ones.
TEST_F(DamagedRecording, PosesThatAreNone) {
    const Trajectory recorded = read_tum_trajectory(recording / "groundtruth.txt");
    for (const char* pose : {"nan 0.4 0.7 1 0 0 0", "0.3 0.4 0.7 0 0 0 0"}) {
        replace_row("groundtruth.txt", 3, 1, pose);
        fs::remove_all(out);
        const Outcome outcome = play("--poses recorded");
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(test::pictures(out), SizeIs(12)) << pose;
        const std::vector<FrameReport> reports = read_reports(out / "frames.jsonl");
        ASSERT_THAT(reports, SizeIs(6)) << pose;
        for (const std::size_t frame : {0, 1, 3, 4, 5}) {
            const Pose& truth = recorded.poses[frame].world_from_camera.pose;
            // what is left is the rounding of stamps to microseconds
            EXPECT_LT(
                glm::distance(reports[frame].world_from_camera.translation, truth.translation),
                1e-6)
                << pose << " frame " << frame;
        }
        const Outcome info = run_program("info " + recording.string());
        EXPECT_THAT(info.out + info.err, HasSubstr("unusable")) << pose;
    }
}

TEST_F(DamagedRecording, OneFrameIsEnough) {
    for (const char* list : {"rgb.txt", "depth.txt"}) {
        const std::string text = file_text(recording / list);
        write_file(recording / list, text.substr(0, text.find('\n', text.find('\n') + 1) + 1));
    }
    const Outcome outcome = play();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(test::pictures(out), SizeIs(2));
}

TEST_F(DamagedRecording, NoRecordingAtAll) {
    fs::create_directory(folder / "empty");
    const Outcome empty = replay(folder / "empty", tiny_scene(), out);
    EXPECT_EQ(empty.code, 65);
    EXPECT_THAT(empty.err, AllOf(HasSubstr("empty"), HasSubstr("rgb.txt and depth.txt")));
    const Outcome none = replay(folder / "none", tiny_scene(), out);
    EXPECT_EQ(none.code, 66);
    EXPECT_THAT(none.err, HasSubstr("none: no such folder"));
    EXPECT_FALSE(fs::exists(out));
}

}  // namespace
}  // namespace inlay
