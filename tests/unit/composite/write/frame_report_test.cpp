// The lines of frames.jsonl: their form, their way back, and what interrupted runs leave.
#include "composite/write/frame_report.h"

#include "recordings/base/check.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace inlay {
namespace {

using test::file_text;
using test::TemporaryFolder;

FrameReport some_report(int frame) {
    FrameReport r;
    r.frame = frame;
    r.time = 0.1 * frame + 1.0 / 3;  // no short decimal form
    r.tracking = TrackingStatus::weak;
    r.world_from_camera.rotation = glm::dmat3(0, 1, 0, -1, 0, 0, 0, 0, 1);
    r.world_from_camera.translation = {0.1, -2.0 / 3, 1e-9};
    r.ms = {1, 2, 3, 4, 5, 6, 7, 28.5};
    r.rays = {10, 20, 30, 40, 5'000'000'000};
    r.pixels = {100, 200, 300};
    r.dropped_samples = 11;
    r.replaced_pixels = 12;
    r.plan = {"environment_direct", "environment_indirect"};
    return r;
}

TEST(FrameReport, IsTheDocumentedLine) {
    FrameReport r;
    r.frame = 12;
    r.time = 0.5;
    r.pixels = {7, 8, 9};
    r.dropped_samples = 3;
    r.replaced_pixels = 4;
    r.plan = {"environment_direct"};
    EXPECT_EQ(to_json_line(r),
              R"({"frame":12,"time_s":0.5,"tracking":"tracked",)"
              R"("world_from_camera":[1.0,0.0,0.0,0.0,0.0,1.0,0.0,0.0,0.0,0.0,1.0,0.0,)"
              R"(0.0,0.0,0.0,1.0],)"
              R"("ms":{"load":0.0,"slam":0.0,"plan":0.0,"trace":0.0,"filter":0.0,)"
              R"("composite":0.0,"write":0.0,"total":0.0},)"
              R"("rays":{"primary":0,"virtual_shadow":0,"virtual_indirect":0,)"
              R"("real_shadow":0,"real_indirect":0},)"
              R"("pixels":{"virtual":7,"influenced":8,"skipped":9},)"
              R"("dropped_samples":3,"replaced_pixels":4,)"
              R"("plan":["environment_direct"]})");
}

TEST(FrameReport, ReadsBackToTheSameBits) {
    const FrameReport written = some_report(3);
    const FrameReport read = from_json_line(to_json_line(written), "line 1");
    EXPECT_EQ(read.time, written.time);
    EXPECT_EQ(read.tracking, TrackingStatus::weak);
    EXPECT_EQ(read.world_from_camera.rotation, written.world_from_camera.rotation);
    EXPECT_EQ(read.world_from_camera.translation, written.world_from_camera.translation);
    EXPECT_EQ(read.rays.real_indirect, 5'000'000'000u);
    EXPECT_EQ(read.dropped_samples, 11u);
    EXPECT_EQ(read.replaced_pixels, 12u);
    EXPECT_EQ(read.exposure, glm::vec3(1));
    EXPECT_EQ(to_json_line(read), to_json_line(written));
}

TEST(FrameReport, AnExposureReadsBackToTheSameBits) {
    FrameReport written = some_report(3);
    written.exposure = {1.0f / 3, 1.7f, 1};
    EXPECT_EQ(from_json_line(to_json_line(written), "line 1").exposure, written.exposure);
}

TEST(FrameReport, AGovernorsChoiceReadsBackWithWhatItLeavesOpen) {
    FrameReport written = some_report(3);
    EXPECT_FALSE(from_json_line(to_json_line(written), "line 1").governor);
    written.governor = GovernedFrame{20, 300.0 / 7, {}, 1e-3 / 3, 41.5};
    const FrameReport read = from_json_line(to_json_line(written), "line 1");
    ASSERT_TRUE(read.governor);
    EXPECT_EQ(read.governor->samples, 20);
    EXPECT_EQ(read.governor->expected_ms, 300.0 / 7);
    EXPECT_FALSE(read.governor->expected_error);
    EXPECT_EQ(read.governor->estimated_error, 1e-3 / 3);
    EXPECT_EQ(to_json_line(read), to_json_line(written));
}

TEST(FrameReports, AreReadInTheOrderOfTheFile) {
    const TemporaryFolder folder;
    for (const int frame : {4, 5, 9})
        append_report(folder / "frames.jsonl", some_report(frame));
    const std::vector<FrameReport> reports = read_reports(folder / "frames.jsonl");
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0].frame, 4);
    EXPECT_EQ(reports[2].frame, 9);
}

TEST(FrameReports, AreNoneWithoutAFile) {
    const TemporaryFolder folder;
    EXPECT_TRUE(read_reports(folder / "frames.jsonl").empty());
}

TEST(FrameReports, IgnoreATornLastLineAndTheNextLineTakesItsPlace) {
    const std::string line = to_json_line(some_report(1)) + "\n";
    for (std::size_t kept = 0; kept < line.size(); kept += 7) {
        const TemporaryFolder folder;
        const auto file = folder / "frames.jsonl";
        std::ofstream(file, std::ios::binary) << line << line.substr(0, kept);
        EXPECT_EQ(read_reports(file).size(), 1u) << kept;
        append_report(file, some_report(2));
        EXPECT_EQ(read_reports(file).size(), 2u) << kept;
        EXPECT_EQ(file_text(file), line + to_json_line(some_report(2)) + "\n");
    }
}

TEST(FrameReports, NameTheLineThatIsDamaged) {
    const TemporaryFolder folder;
    const auto file = folder / "frames.jsonl";
    std::ofstream(file) << to_json_line(some_report(1)) << "\n{\"frame\": 2}\n"
                        << to_json_line(some_report(3)) << "\n";
    try {
        read_reports(file);
        FAIL() << "the damage was not seen";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::bad_data);
        EXPECT_NE(std::string(e.what()).find("line 2"), std::string::npos) << e.what();
    }
}

TEST(FrameReports, RefuseAnUnknownTrackingStatus) {
    std::string line = to_json_line({});
    const std::string known = "\"tracked\"";
    line.replace(line.find(known), known.size(), "\"perhaps\"");
    EXPECT_THROW(from_json_line(line, "line 1"), Error);
}

}  // namespace
}  // namespace inlay
