// The geometry check on a scene in closed form, and the readers on the real recordings.
#include "recordings/readers/geometry_check.h"

#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::vector<int> first_frames(int count) {
    std::vector<int> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(i);
    return frames;
}

double relative(const GeometryCheck& check, const std::string& name) {
    for (const GeometryResidual& r : check.results)
        if (r.name == name) return r.relative;
    ADD_FAILURE() << "no reading is called " << name;
    return 0;
}

TEST(GeometryCheck, TheRightReadingFitsToThePixelGrid) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), first_frames(30));
    const GeometryCheck check = check_geometry(open_recording(folder.path()));
    EXPECT_EQ(check.pairs, 20);
    // Landing on the nearest pixel moves a sample by half a pixel at most, z / 128 to the side;
    // times the wall's slope, up to 0.9 from the turned cameras, 0.7 % of z; the median is half.
    EXPECT_LT(check.results.front().relative, 0.0035);
    EXPECT_FALSE(check.better.has_value()) << check.better->name;
    for (const GeometryResidual& r : check.results)
        EXPECT_GE(r.relative, check.results.front().relative) << r.name;
}

TEST(GeometryCheck, AWrongScaleShows) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), first_frames(30), 5000);
    const GeometryCheck check = check_geometry(open_recording(folder.path()));
    ASSERT_TRUE(check.better.has_value());
    EXPECT_EQ(check.better->name, "depth scale 5000");
}

TEST(GeometryCheck, InvertedPosesShow) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), first_frames(30));
    for (const int n : first_frames(30))
        test::write_file(folder / (test::frame_name(n) + ".pose.txt"),
                         test::rows_text(inverse(test::pose_on_path(n))));
    const GeometryCheck check = check_geometry(open_recording(folder.path()));
    ASSERT_TRUE(check.better.has_value());
    EXPECT_EQ(check.better->name, "poses inverted");
}

TEST(GeometryCheck, WithoutPosesThereIsNothingToCheck) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), first_frames(3));
    for (const int n : first_frames(3))
        fs::remove(folder / (test::frame_name(n) + ".pose.txt"));
    EXPECT_EQ(check_geometry(open_recording(folder.path())).pairs, 0);
}

struct RealRecording {
    const char* folder;
    std::size_t frames;
    double depth_scale;
    double largest_relative;  // of the chosen reading
};

class RealData : public testing::TestWithParam<RealRecording> {};

// Sensor noise allows 1 % of z, and 0.5 % without it (rendered depth, reconstructed poses).
INSTANTIATE_TEST_SUITE_P(Readers, RealData,
                         testing::Values(RealRecording{"kitchen", 250, 1000, 0.01},
                                         RealRecording{"icl_livingroom", 211, 1000, 0.005},
                                         RealRecording{"tum_fr1_rpy", 60, 5000, 0.01},
                                         RealRecording{"open3d_samples/RGBD", 5, 1000, 0.01}));

TEST_P(RealData, ChosenConventionsFitAndInvertedPosesDoNot) {
    const fs::path folder = fs::path(INLAY_DATA_DIR) / "recordings" / GetParam().folder;
    if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is not here";
    const Recording recording = open_recording(folder);
    EXPECT_EQ(recording.info.frames.size(), GetParam().frames);
    EXPECT_EQ(recording.info.units_per_metre, GetParam().depth_scale);
    EXPECT_EQ(recording.info.unusable_poses, 0);
    const GeometryCheck check = check_geometry(recording);
    EXPECT_LT(check.results.front().relative, GetParam().largest_relative);
    EXPECT_GT(relative(check, "poses inverted"), 4 * check.results.front().relative);
    EXPECT_FALSE(check.better.has_value()) << check.better->name;
}

TEST(RealRecordings, KitchenUpIsTheNormalOfItsTable) {
    const fs::path folder = fs::path(INLAY_DATA_DIR) / "recordings/kitchen";
    if (!fs::is_directory(folder)) GTEST_SKIP() << folder << " is not here";
    const Recording recording = open_recording(folder);
    const RgbdFrame frame = recording.load(0);
    const auto point = [&](int x, int y) {
        return *frame.recorded_world_from_camera *
               (double(frame.depth(x, y)) * unproject(frame.lens, {x, y}));
    };
    // Three pixels on the bare table top, far apart; noise of 5 mm over 0.3 m is 1 degree, the
    // table's own lean 2.
    const glm::dvec3 a = point(370, 290), b = point(480, 240), c = point(590, 350);
    const glm::dvec3 normal = glm::normalize(glm::cross(c - a, b - a));
    ASSERT_TRUE(recording.info.up.has_value());
    EXPECT_GT(glm::dot(normal, *recording.info.up), std::cos(glm::radians(6.0)));
}

}  // namespace
}  // namespace inlay
