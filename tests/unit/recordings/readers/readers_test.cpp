// Each reader on a small folder whose content is known.
#include "recordings/base/check.h"
#include "recordings/readers/recording.h"
#include "recordings/readers/trajectory.h"
#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

namespace inlay {
namespace {

using test::TemporaryFolder;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

double distance(const Pose& a, const Pose& b) {
    return glm::distance(a.translation, b.translation) + rotation_angle(a, b);
}

TEST(ThreeDMatch, GivesFramesAsWritten) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {3, 10, 100});
    test::write_file(folder / "gravity-direction.txt", "0\n0.6\n0.8\n");
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.info.profile, "3dmatch");
    EXPECT_THAT(recording.info.frames, ElementsAre(3, 10, 100));
    EXPECT_TRUE(recording.info.synthetic_times);
    EXPECT_NEAR(recording.info.times[1], 7 / 30.0, 1e-9);  // stamps are whole ns
    ASSERT_TRUE(recording.info.up.has_value());
    EXPECT_LT(glm::distance(*recording.info.up, glm::dvec3(0, -0.6, -0.8)), 1e-12);
    const RgbdFrame frame = recording.load(10);
    EXPECT_EQ(frame.index, 10);
    EXPECT_EQ(frame.color(5, 7), (EncodedRgb{10, 20, 30}));
    EXPECT_EQ(frame.lens.width, 64);
    EXPECT_EQ(frame.lens.cx, 31.5);
    const glm::dvec3 ray = unproject(frame.lens, {20, 30});
    // Half a stored unit, 0.5 mm, and the rounding of floats.
    EXPECT_NEAR(frame.depth(20, 30), test::wall_depth(test::pose_on_path(10), ray), 0.501e-3);
    ASSERT_TRUE(frame.recorded_world_from_camera.has_value());
    EXPECT_LT(distance(*frame.recorded_world_from_camera, test::pose_on_path(10)), 1e-12);
}

TEST(ThreeDMatch, TakesTheLensFromOneLevelUp) {
    TemporaryFolder folder;
    test::write_three_d_match(folder / "seq-01", {0});
    std::filesystem::rename(folder / "seq-01/camera-intrinsics.txt",
                            folder / "camera-intrinsics.txt");
    const RecordingInfo info = open_recording(folder / "seq-01").info;
    EXPECT_EQ(info.profile, "3dmatch");
    EXPECT_EQ(info.lens.fx, 64);
}

TEST(SevenScenes, AssumesTheKinectAndNeedsNoPoses) {
    TemporaryFolder folder;
    test::write_color(folder / "frame-000000.color.png", 320, 240);
    test::write_depth(folder / "frame-000000.depth.png", 320, 240, 65535);
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.info.profile, "7scenes");
    EXPECT_EQ(recording.info.lens.fx, 292.5);   // 585 at half the size
    EXPECT_EQ(recording.info.lens.cx, 159.75);  // (320 + 1/2) / 2 - 1/2
    EXPECT_THAT(recording.info.warnings, Contains(HasSubstr("lens 585")));
    EXPECT_EQ(recording.info.pose_source, "none");
    const RgbdFrame frame = recording.load(0);
    EXPECT_FALSE(frame.recorded_world_from_camera.has_value());
    EXPECT_EQ(frame.depth(3, 3), 0.0f);  // 65535: not measured
}

void write_tum(const std::filesystem::path& folder) {
    std::string rgb = "# color images\n", depth = "# depth maps\n";
    for (int i = 0; i < 4; ++i) {
        const std::string stamp = std::to_string(1000 + i);
        rgb += stamp + ".000001 rgb/" + stamp + ".png\n";
        depth += stamp + (i == 2 ? ".300000" : ".010000") + " depth/" + stamp + ".png\n";
        test::write_color(folder / ("rgb/" + stamp + ".png"), 64, 48);
        test::write_depth(folder / ("depth/" + stamp + ".png"), 64, 48, 5000 * (i + 1));
    }
    test::write_file(folder / "rgb.txt", rgb);
    test::write_file(folder / "depth.txt", depth);
}

TEST(Tum, PairsByTimeAndInterpolatesPoses) {
    TemporaryFolder folder;
    write_tum(folder.path());
    test::write_file(folder / "groundtruth.txt",
                     "1000.000001 1 2 3 0 0 0 1\n"
                     "1000.980001 0 0 0 0 0 0 1\n1001.020001 0.4 0 0 0 0 0.6 0.8\n");
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.info.profile, "tum");
    EXPECT_THAT(recording.info.frames, ElementsAre(0, 1, 2));  // 1002 has no partner within 20 ms
    EXPECT_NEAR(recording.info.times[2], 3.0, 1e-9);
    EXPECT_THAT(recording.info.warnings, Contains(HasSubstr("lens 525")));
    const RgbdFrame last = recording.load(2);
    EXPECT_EQ(last.depth(0, 0), 4.0f);  // 20000 units
    EXPECT_FALSE(last.recorded_world_from_camera.has_value());
    const auto& poses = recording.info.world_from_camera;
    EXPECT_EQ(poses[0]->translation, glm::dvec3(1, 2, 3));
    // Half-way between the neighbours: half the distance, half the angle 2 atan(0.6 / 0.8).
    EXPECT_NEAR(poses[1]->translation.x, 0.2, 1e-9);
    EXPECT_NEAR(rotation_angle(*poses[1], Pose{}), std::atan2(0.6, 0.8), 1e-9);
}

TEST(Tum, KnowsItsCamerasByName) {
    TemporaryFolder folder;
    for (const char* name : {"rgbd_dataset_freiburg1_desk", "my_fr2", "FR3-office"}) {
        write_tum(folder / name);
        EXPECT_NE(open_recording(folder / name).info.lens.fx, 525.0 / 10) << name;
    }
    const Lens desk = open_recording(folder / "rgbd_dataset_freiburg1_desk").info.lens;
    EXPECT_NEAR(desk.fx, 51.73, 1e-9);  // for 640 px; the images here have 64
    EXPECT_EQ(desk.k3, 1.1633);
    EXPECT_EQ(desk.p1, -0.0054);
    EXPECT_FALSE(distorted(open_recording(folder / "FR3-office").info.lens));
}

TEST(Tum, CameraFileOverridesLensScaleAndUp) {
    TemporaryFolder folder;
    write_tum(folder / "fr1");
    test::write_file(folder / "fr1/groundtruth.txt", "1000.000001 1 2 3 0 0 0 1\n");
    test::write_file(folder / "fr1/camera.json",
                     R"({"width": 64, "height": 48, "lens": [60, 61, 30, 20],
                         "depth_scale": 2500, "up": [0, 2, 0]})");
    const Recording recording = open_recording(folder / "fr1");
    EXPECT_EQ(recording.info.lens.fy, 61);
    EXPECT_FALSE(distorted(recording.info.lens));
    EXPECT_EQ(recording.info.up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(recording.load(0).depth(0, 0), 2.0f);  // 5000 units
}

void write_redwood(const std::filesystem::path& folder, const std::string& log) {
    for (const char* number : {"1", "2", "10"}) {
        const std::string name(number);
        test::write_color(folder / "image" / (name + ".jpg"), 64, 48);
        test::write_depth(folder / "depth" / (name + ".png"), 64, 48, 1500);
    }
    std::string text;
    for (int i = 0; i < 3; ++i)
        text += std::to_string(i) + " 0 1.5\n" + test::rows_text(test::pose_on_path(i));
    test::write_file(folder / log, text);
}

TEST(Redwood, SortsByNumberAndCountsPosesInThatOrder) {
    TemporaryFolder folder;
    write_redwood(folder.path(), "test_scene/trajectory.log");
    const Recording recording = open_recording(folder.path());
    EXPECT_EQ(recording.info.profile, "open3d");
    EXPECT_THAT(recording.info.frames, ElementsAre(1, 2, 10));
    EXPECT_EQ(recording.load(10).depth(1, 1), 1.5f);
    EXPECT_LT(distance(*recording.load(10).recorded_world_from_camera, test::pose_on_path(2)),
              1e-12);
    EXPECT_EQ(recording.info.lens.fx, 52.5);  // 525 for 640 px
}

TEST(Redwood, ReadsTheLensColumnByColumn) {
    TemporaryFolder folder;
    write_redwood(folder.path(), "trajectory.log");
    test::write_file(folder / "camera_intrinsic.json",
                     R"({"width": 64, "height": 48, "intrinsic_matrix":
                         [70, 0, 0, 0, 71, 0, 31, 23, 1]})");
    const Lens lens = open_recording(folder.path()).info.lens;
    EXPECT_EQ(glm::dvec4(lens.fx, lens.fy, lens.cx, lens.cy), glm::dvec4(70, 71, 31, 23));
}

TEST(Redwood, PairsByTheStampsOfObjectScans) {
    TemporaryFolder folder;
    for (const char* name : {"0000001-000000000000", "0000002-000000033000"})
        test::write_color(folder / "rgb" / (std::string(name) + ".jpg"), 64, 48);
    for (const char* name : {"0000001-000000031000", "0000002-000000064000"})
        test::write_depth(folder / "depth" / (std::string(name) + ".png"), 64, 48, 1000);
    const RecordingInfo info = open_recording(folder.path()).info;
    EXPECT_THAT(info.frames, ElementsAre(2));
    EXPECT_FALSE(info.synthetic_times);
}

TEST(OpenOptions, OverrideWhatIsFound) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0});
    test::write_depth(folder / "frame-000000.depth.png", 64, 48, 3000);
    OpenOptions options;
    options.profile = "7scenes";
    options.depth_scale = 2000;
    options.lens = glm::dvec4(50, -51, 30, 20);
    options.distortion = {0.1, 0.2, 0.3, 0.4, 0.5};
    const Recording recording = open_recording(folder.path(), options);
    EXPECT_EQ(recording.info.profile, "7scenes");
    EXPECT_EQ(recording.info.lens.fy, -51);
    EXPECT_EQ(recording.info.lens.p1, 0.3);
    EXPECT_EQ(recording.info.lens.k3, 0.5);
    EXPECT_EQ(recording.load(0).depth(0, 0), 1.5f);
    options.max_depth = 1.4f;
    EXPECT_EQ(open_recording(folder.path(), options).load(0).depth(0, 0), 0.0f);
}

}  // namespace
}  // namespace inlay
