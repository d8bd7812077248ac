// Damaged, missing and malicious recordings: the right exit code, and a message that names the
// file.
#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/readers/geometry_check.h"
#include "recordings/readers/image_files.h"
#include "recordings/readers/recording.h"
#include "recordings/readers/trajectory.h"
#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// Expects an Error with this code whose message holds every one of the texts.
void expect_refusal(const std::function<void()>& action, ExitCode code,
                    const std::vector<std::string>& texts) {
    try {
        action();
        ADD_FAILURE() << "was accepted; expected a message with " << texts.front();
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << error.what();
        for (const std::string& text : texts)
            EXPECT_THAT(error.what(), HasSubstr(text));
    }
}

void cut_file(const fs::path& file, double share) {
    fs::resize_file(file, std::uintmax_t(double(fs::file_size(file)) * share));
}

cv::Mat noise(int type) {
    cv::Mat image(48, 64, type);
    cv::randu(image, 0, 255);
    return image;
}

TEST(BadFolder, MissingEmptyUnknownAndNotAFolder) {
    TemporaryFolder folder;
    const auto open = [](const fs::path& path) { return [path] { open_recording(path); }; };
    expect_refusal(open(folder / "none"), ExitCode::input_missing, {"none", "no such folder"});
    const std::vector<std::string> sought{folder.path().string(), "rgb.txt", "frame-000000",
                                          "depth/"};
    expect_refusal(open(folder.path()), ExitCode::bad_data, sought);
    test::write_file(folder / "notes.txt", "hello");
    expect_refusal(open(folder.path()), ExitCode::bad_data, sought);
    expect_refusal(open(folder / "notes.txt"), ExitCode::bad_data, {"notes.txt", "found a file"});
}

TEST(BadFolder, RecognisedButWithoutAFrame) {
    TemporaryFolder folder;
    fs::create_directories(folder / "color");
    fs::create_directories(folder / "depth");
    expect_refusal([&] { open_recording(folder.path()); }, ExitCode::bad_data,
                   {folder.path().string(), "found no frame"});
    test::write_file(folder / "rgb.txt", "# nothing\n");
    test::write_file(folder / "depth.txt", "");
    expect_refusal([&] { open_recording(folder.path()); }, ExitCode::bad_data, {"found no frame"});
}

TEST(BadFolder, FramesWithoutAPartnerAreLeftOut) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1, 2, 3});
    fs::remove(folder / "frame-000001.depth.png");
    fs::remove(folder / "frame-000002.color.png");
    const Recording recording = open_recording(folder.path());
    EXPECT_THAT(recording.info.frames, ElementsAre(0, 3));
    EXPECT_THAT(recording.info.warnings, Contains(HasSubstr("1 frame (1) left out")));
    EXPECT_THAT(recording.info.warnings, Contains(HasSubstr("1 frame (2) left out")));
    expect_refusal([&] { recording.load(1); }, ExitCode::bad_data, {"no frame 1"});
}

TEST(BadOptions, AreUsageErrors) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0});
    const auto open_with = [&](const OpenOptions& options) {
        return [&folder, options] { open_recording(folder.path(), options); };
    };
    OpenOptions profile, scale, lens, depth;
    profile.profile = "kinect";
    scale.depth_scale = -1000;
    lens.lens = glm::dvec4(0, 1, 2, 3);
    depth.max_depth = std::numeric_limits<float>::quiet_NaN();
    expect_refusal(open_with(profile), ExitCode::usage, {"kinect", "3dmatch"});
    expect_refusal(open_with(scale), ExitCode::usage, {"--depth-scale"});
    expect_refusal(open_with(lens), ExitCode::usage, {"--lens"});
    expect_refusal(open_with(depth), ExitCode::usage, {"--max-depth"});
}

TEST(BadDepth, OnlySixteenBitsAndOneChannelPass) {
    TemporaryFolder folder;
    test::write_image(folder / "grey8.png", noise(CV_8UC1));
    test::write_image(folder / "rgb16.png", noise(CV_16UC3));
    test::write_image(folder / "rgb8.png", noise(CV_8UC3));
    test::write_image(folder / "lossy.jpg", noise(CV_8UC1));
    test::write_image(folder / "grey8.pgm", noise(CV_8UC1));
    for (const char* name : {"grey8.png", "rgb16.png", "rgb8.png", "lossy.jpg", "grey8.pgm"})
        expect_refusal([&] { read_depth(folder / name, 1000, 0); }, ExitCode::bad_data,
                       {name, "expected depth as a 16-bit"});
    test::write_image(folder / "good.pgm", noise(CV_16UC1));
    EXPECT_EQ(read_depth(folder / "good.pgm", 1000, 0).width, 64);
}

TEST(BadDepth, APaletteIsRefusedByItsHeader) {
    TemporaryFolder folder;
    std::string bytes("\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x40\0\0\0\x30\x08\x03\0\0\0", 29);
    test::write_file(folder / "palette.png", bytes + std::string(64, '\0'));
    expect_refusal([&] { read_depth(folder / "palette.png", 1000, 0); }, ExitCode::bad_data,
                   {"palette.png", "8-bit palette PNG"});
}

TEST(BadDepth, WrongDepthStopsTheOpening) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0});
    test::write_image(folder / "frame-000000.depth.png", noise(CV_8UC1));
    expect_refusal([&] { open_recording(folder.path()); }, ExitCode::bad_data,
                   {"frame-000000.depth.png", "8-bit PNG"});
}

TEST(BadImages, CutOffAtAnyPlaceAreRefused) {
    TemporaryFolder folder;
    for (const double share : {0.99, 0.9, 0.5, 0.1, 0.01, 0.0}) {
        test::write_image(folder / "d.png", noise(CV_16UC1));
        test::write_image(folder / "c.png", noise(CV_8UC3));
        test::write_image(folder / "c.jpg", noise(CV_8UC3));
        for (const char* name : {"d.png", "c.png", "c.jpg"})
            cut_file(folder / name, share);
        expect_refusal([&] { read_depth(folder / "d.png", 1000, 0); }, ExitCode::bad_data,
                       {"d.png"});
        for (const char* name : {"c.png", "c.jpg"})
            expect_refusal([&] { read_color(folder / name); }, ExitCode::bad_data, {name});
    }
}

TEST(BadImages, DeepColorAndHugeSizesAreRefused) {
    TemporaryFolder folder;
    test::write_image(folder / "deep.png", noise(CV_16UC3));
    expect_refusal([&] { read_color(folder / "deep.png"); }, ExitCode::bad_data,
                   {"deep.png", "16-bit"});
    test::write_file(folder / "huge.pgm", "P5 99999999999 99999999999 65535\n");
    expect_refusal([&] { read_depth(folder / "huge.pgm", 1000, 0); }, ExitCode::bad_data,
                   {"huge.pgm", "16384 px"});
    test::write_file(folder / "text.png", "this is no image");
    expect_refusal([&] { read_color(folder / "text.png"); }, ExitCode::bad_data,
                   {"text.png", "this is"});
}

TEST(BadImages, ADamagedFrameFailsAloneAndByName) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1, 2});
    cut_file(folder / "frame-000001.depth.png", 0.6);
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.load(0).index, 0);
    expect_refusal([&] { recording.load(1); }, ExitCode::bad_data, {"frame-000001.depth.png"});
    fs::remove(folder / "frame-000002.color.png");
    expect_refusal([&] { recording.load(2); }, ExitCode::input_missing, {"frame-000002.color.png"});
    EXPECT_EQ(check_geometry(recording).pairs, 0);
}

TEST(BadImages, SizesThatDisagree) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1});
    test::write_depth(folder / "frame-000001.depth.png", 32, 24, 1000);
    const Recording recording = open_recording(folder.path());
    expect_refusal([&] { recording.load(1); }, ExitCode::bad_data,
                   {"frame-000001.depth.png", "32 x 24", "64 x 48"});
    test::write_depth(folder / "frame-000000.depth.png", 32, 24, 1000);
    expect_refusal([&] { open_recording(folder.path()); }, ExitCode::bad_data,
                   {"frame-000000.depth.png", "registration", "not available"});
}

TEST(BadPoses, AreCountedAndSpoilNothingElse) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1, 2, 3, 4});
    test::write_file(folder / "frame-000001.pose.txt", "nan 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    test::write_file(folder / "frame-000002.pose.txt", "2 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n");
    test::write_file(folder / "frame-000003.pose.txt", "1 0 0 0\n0 1 zero 0\n");
    fs::remove(folder / "frame-000004.pose.txt");
    const RecordingInfo info = open_recording(folder.path()).info;
    EXPECT_EQ(info.unusable_poses, 3);
    EXPECT_TRUE(info.world_from_camera[0].has_value());
    for (std::size_t i = 1; i < 5; ++i)
        EXPECT_FALSE(info.world_from_camera[i].has_value()) << i;
    EXPECT_THAT(info.warnings, Contains(HasSubstr("3 frames (1, 2, 3) is unusable")));
    EXPECT_THAT(info.warnings, Contains(HasSubstr("1 frame (4) without")));
}

TEST(BadText, IntrinsicsAndGravityNameFileAndLine) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0});
    const auto open = [&] { open_recording(folder.path()); };
    for (const char* text : {"64 0 31.5\n0 sixty 23.5\n0 0 1\n", "64 0 31.5\n0 64\n0 0 1\n"}) {
        test::write_file(folder / "camera-intrinsics.txt", text);
        expect_refusal(open, ExitCode::bad_data, {"camera-intrinsics.txt:2", "expected 3 numbers"});
    }
    for (const char* text :
         {"", "64 0 31.5\n", "0 0 0\n0 0 0\n0 0 0\n", "nan 0 0\n0 1 0\n0 0 1\n"}) {
        test::write_file(folder / "camera-intrinsics.txt", text);
        expect_refusal(open, ExitCode::bad_data, {"camera-intrinsics.txt", "expected"});
    }
    test::write_file(folder / "camera-intrinsics.txt", "64 0 31.5\n0 64 23.5\n0 0 1\n");
    for (const char* text : {"", "0 1\n", "0 0 0\n", "down", "nan 0 1\n"}) {
        test::write_file(folder / "gravity-direction.txt", text);
        expect_refusal(open, ExitCode::bad_data, {"gravity-direction.txt", "direction"});
    }
}

void write_tum(const fs::path& folder, const std::string& rgb, const std::string& truth) {
    test::write_color(folder / "rgb/1.png", 64, 48);
    test::write_depth(folder / "depth/1.png", 64, 48, 5000);
    test::write_file(folder / "rgb.txt", rgb);
    test::write_file(folder / "depth.txt", "1.0 depth/1.png\n2.0 depth/1.png\n");
    test::write_file(folder / "groundtruth.txt", truth);
}

TEST(BadText, TumListsNameFileAndLine) {
    TemporaryFolder folder;
    const auto open = [&] { open_recording(folder.path()); };
    for (const char* row : {"one rgb/1.png", "1.0", "1.0 rgb/1.png extra", "1e9 rgb/1.png",
                            "nan rgb/1.png", "99999999999 rgb/1.png", "\x01\xff\x02"}) {
        write_tum(folder.path(), std::string("# a comment\n") + row + "\n", "");
        expect_refusal(open, ExitCode::bad_data, {"rgb.txt:2: found '", "expected 'stamp path'"});
    }
    for (const char* row : {"1.0 ../rgb/1.png", "1.0 /etc/passwd", "1.0 rgb/../../x.png"}) {
        write_tum(folder.path(), std::string(row) + "\n", "");
        expect_refusal(open, ExitCode::bad_data, {"rgb.txt:1", "below the recording's folder"});
    }
    for (const char* row : {"1.0 0 0 0 0 0 0", "1.0 0 0 0 0 0 0 one", "x 0 0 0 0 0 0 1"}) {
        write_tum(folder.path(), "1.0 rgb/1.png\n", std::string(row) + "\n");
        expect_refusal(open, ExitCode::bad_data, {"groundtruth.txt:1", "expected 't tx ty tz"});
    }
}

TEST(BadText, TumWarnsOfTimeGoingBackwardsAndOfBadQuaternions) {
    TemporaryFolder folder;
    write_tum(folder.path(), "2.0 rgb/1.png\n1.0 rgb/1.png\n",
              "2.0 0 0 0 0 0 0 1\n1.0 0 0 0 0 0 0 0\n1.0 5 5 5 0 0 0 1\n");
    const RecordingInfo info = open_recording(folder.path()).info;
    EXPECT_THAT(info.warnings, Contains(HasSubstr("rgb.txt: time goes backwards")));
    EXPECT_THAT(info.warnings, Contains(HasSubstr("groundtruth.txt: time goes backwards")));
    EXPECT_THAT(info.warnings, Contains(HasSubstr("repeat a stamp")));
    EXPECT_THAT(info.warnings, Contains(HasSubstr("quaternion has length 0")));
    EXPECT_EQ(info.unusable_poses, 1);
    EXPECT_THAT(info.times, ElementsAre(0.0, 1.0));
}

TEST(BadText, MissingImagesOfAListAreLeftOutWithoutRenumbering) {
    TemporaryFolder folder;
    write_tum(folder.path(), "1.0 rgb/none.png\n2.0 rgb/1.png\n", "");
    const RecordingInfo info = open_recording(folder.path()).info;
    EXPECT_THAT(info.frames, ElementsAre(1));
    EXPECT_THAT(info.warnings, Contains(HasSubstr("none.png")));
}

TEST(BadText, CameraFiles) {
    TemporaryFolder folder;
    write_tum(folder / "tum", "1.0 rgb/1.png\n", "");
    for (const char* text :
         {"", "{", "[]", "{\"lens\": [1, 2, 3]}", "{\"lens\": [1, 2, 3, 4]}", "{\"up\": 3}",
          "{\"lens\": [1,2,3,4], \"width\": 1e300, \"height\": 48}", "{\"depth_scale\": 0}",
          "{\"depth_scale\": \"mm\"}", "{\"up\": [0,0,0]}"}) {
        test::write_file(folder / "tum/camera.json", text);
        expect_refusal([&] { open_recording(folder / "tum"); }, ExitCode::bad_data,
                       {"camera.json"});
    }
    test::write_color(folder / "o3d/color/0.png", 64, 48);
    test::write_depth(folder / "o3d/depth/0.png", 64, 48, 1000);
    for (const char* text : {"", "{}", "{\"width\": 64, \"height\": 48, \"intrinsic_matrix\": [1]}",
                             "{\"width\": 64, \"height\": 48, \"intrinsic_matrix\": \"K\"}"}) {
        test::write_file(folder / "o3d/camera_intrinsic.json", text);
        expect_refusal([&] { open_recording(folder / "o3d"); }, ExitCode::bad_data,
                       {"camera_intrinsic.json"});
    }
}

TEST(BadText, LogTrajectories) {
    TemporaryFolder folder;
    const auto read = [&] { read_log_trajectory(folder / "t.log"); };
    for (const char* text : {"0 0 1\n1 0 0 0\n", "0 0\n", "-1 0 0\n1 0 0 0\n", "nan 0 0\n",
                             "0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1\n0 0 0 1\n"}) {
        test::write_file(folder / "t.log", text);
        expect_refusal(read, ExitCode::bad_data, {"t.log:", "found '", "expected"});
    }
    test::write_file(folder / "t.log", "");
    EXPECT_TRUE(read_log_trajectory(folder / "t.log").empty());
}

TEST(BadText, RandomBytesNeverCrashAReader) {
    TemporaryFolder folder;
    test::write_three_d_match(folder / "a", {0});
    write_tum(folder / "b", "1.0 rgb/1.png\n", "");
    std::uint32_t state = 1;
    for (int round = 0; round < 200; ++round) {
        std::string bytes;
        for (int i = 0; i < 80; ++i) {
            state = state * 1664525u + 1013904223u;
            const bool plausible = (state >> 20) % 4 != 0;
            bytes += plausible ? "0123456789 .-\nenaif"[(state >> 24) % 19] : char(state >> 24);
        }
        for (const char* file : {"a/camera-intrinsics.txt", "a/gravity-direction.txt",
                                 "a/frame-000000.pose.txt", "b/rgb.txt", "b/groundtruth.txt"}) {
            test::write_file(folder / file, bytes);
            try {
                open_recording(folder / std::string(file, 1));
            } catch (const Error& error) {
                EXPECT_THAT(error.what(), HasSubstr(folder.path().string()));
            }
        }
    }
}

TEST(WriteTrajectory, FailuresNameTheFileAndLeaveNothingBehind) {
    TemporaryFolder folder;
    expect_refusal([&] { write_tum_trajectory(folder / "none/poses.txt", {}); },
                   ExitCode::cannot_create, {"none/poses.txt"});
    fs::create_directories(folder / "poses.txt/kept");
    expect_refusal([&] { write_tum_trajectory(folder / "poses.txt", {}); }, ExitCode::cannot_create,
                   {"poses.txt"});
    EXPECT_TRUE(fs::is_directory(folder / "poses.txt/kept"));
    EXPECT_EQ(folder.entries(), 1);
}

TEST(Threads, GeometryCheckDoesNotDependOnTheirNumber) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1, 2, 3, 4, 5, 6, 7});
    const Recording recording = open_recording(folder.path());
    std::vector<GeometryCheck> checks;
    for (const int threads : {1, 2, 5}) {
        set_thread_count(threads);
        checks.push_back(check_geometry(recording));
    }
    for (const GeometryCheck& check : checks) {
        ASSERT_EQ(check.results.size(), checks[0].results.size());
        for (std::size_t i = 0; i < check.results.size(); ++i) {
            EXPECT_EQ(check.results[i].metres, checks[0].results[i].metres);
            EXPECT_EQ(check.results[i].samples, checks[0].results[i].samples);
        }
    }
}

}  // namespace
}  // namespace inlay
