// `inlay accuracy` as its user meets it where input is poor, damaged or odd.
#include "composite/write/write_exr.h"
#include "recordings/environment/exr_image.h"
#include "tests/support/accuracy_runs.h"

#include <OpenEXR/ImfRgbaFile.h>

#include <cmath>
#include <limits>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::accuracy;
using test::ball;
using test::file_text;
using test::Outcome;
using test::record_ball;
using test::report_of;
using test::scene_with_ball;
using test::TemporaryFolder;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// Writes the picture again with one pixel that is not a number.
void spoil(const fs::path& file, std::size_t pixel) {
    const Image<Rgb> picture = read_exr(file);
    std::vector<Imf::Rgba> pixels;
    for (const Rgb& c : picture.pixels)
        pixels.emplace_back(c.r, c.g, c.b);
    pixels[pixel].g = std::numeric_limits<float>::quiet_NaN();
    Imf::RgbaOutputFile exr(file.string().c_str(), picture.width, picture.height, Imf::WRITE_RGB);
    exr.setFrameBuffer(pixels.data(), 1, std::size_t(picture.width));
    exr.writePixels(picture.height);
}

/// The only work of a run that must have gone well.
json work_of(const fs::path& recording, const fs::path& out) {
    const Outcome outcome = accuracy(recording, out);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    if (outcome.code != 0) return {{"cells", json::array()}};
    return report_of(out)["works"][0];
}

std::vector<json> figures(const json& work, const char* reference, const char* name) {
    std::vector<json> all;
    for (const json& cell : work["cells"])
        all.push_back(cell[reference].is_null() ? json() : cell[reference][name]);
    return all;
}

MATCHER(IsFiniteNumber, "") { return arg.is_number() && std::isfinite(arg.template get<double>()); }
MATCHER(IsNull, "") { return arg.is_null(); }

TEST(Accuracy, MeasuresAWorkWithoutTruth) {
    const TemporaryFolder folder;
    const fs::path recording =
        record_ball(folder, scene_with_ball(0.2, 0.9), "--length 3 --truth none");
    const json work = work_of(recording, folder / "out");
    ASSERT_THAT(work["cells"], testing::Not(IsEmpty()));
    EXPECT_THAT(figures(work, "truth", "rmse"), Each(IsNull()));
    EXPECT_THAT(figures(work, "converged", "rmse"), Each(IsFiniteNumber()));
    EXPECT_TRUE(work["blame"].is_null());
    EXPECT_EQ(work["frames"], json({1, 2}));  // which both have a frame before them
    EXPECT_TRUE(work["budget"].is_null());
    const Outcome blame = accuracy(recording, folder / "none", "--blame");
    EXPECT_EQ(blame.code, 65);
    EXPECT_THAT(blame.err, HasSubstr("inlay record --truth"));
}

TEST(Accuracy, WritesFiguresAgainstBothReferencesAPageAndASummary) {
    const TemporaryFolder folder;
    const json work = work_of(ball(), folder / "out");
    // unfiltered; filtered with and without the previous frame; each with 4, 16 and 64 samples
    ASSERT_THAT(work["cells"], SizeIs(9));
    for (const char* reference : {"converged", "truth"})
        EXPECT_THAT(figures(work, reference, "rmse_influenced"), Each(IsFiniteNumber()));
    EXPECT_EQ(work["reference"]["truth_samples"], 64);
    EXPECT_THAT(work["blame"], SizeIs(2 * 5));  // frames x stages
    ASSERT_THAT(work["budget"], SizeIs(2));
    for (const json& frame : work["budget"]) {
        ASSERT_THAT(frame["figures"], SizeIs(4));  // RMSE, E_R, E_RV, flicker
        bool kept = true;
        for (const json& figure : frame["figures"]) {
            EXPECT_THAT(figure["allowed"], IsFiniteNumber());
            kept = kept && figure["value"] <= figure["allowed"];
        }
        EXPECT_EQ(frame["kept"], kept);
        EXPECT_GT(frame["figures"][0]["allowed"], 0);
    }
    EXPECT_THAT(file_text(folder / "out/accuracy.html"), HasSubstr("samples=16/difference"));
    EXPECT_THAT(file_text(folder / "out/summary.md"),
                AllOf(HasSubstr("| ball | Difference form |"), HasSubstr("\nBudget: ")));
}

TEST(Accuracy, PrintsTheBlameTableWithoutAFolder) {
    std::string line;
    for (const std::string& argument : test::small_run)
        line += argument + " ";
    line = "accuracy " + ball().string() + " --blame " + line;
    const Outcome table = test::run_program(line);
    ASSERT_EQ(table.code, 0) << table.err;
    EXPECT_THAT(table.out, testing::StartsWith("| work | frame | RMSE |"));
    EXPECT_THAT(table.out, AllOf(HasSubstr("\n| ball | 1 |"), HasSubstr("\n| ball | 2 |")));
    const Outcome data = test::run_program(line + "--json");
    ASSERT_EQ(data.code, 0) << data.err;
    const json report = json::parse(data.out);
    EXPECT_EQ(report["kind"], "blame");
    EXPECT_EQ(report["works"][0]["name"], "ball");
    EXPECT_THAT(report["works"][0]["blame"], SizeIs(2 * 5));
}

TEST(Accuracy, WarnsOfAnEnvironmentThatHadToBeMended) {
    const TemporaryFolder folder;
    const Image<Rgb> light(8, 4, Rgb(1));
    ExrFile exr;
    exr.picture = &light;
    write_exr(folder / "sky.exr", exr);
    spoil(folder / "sky.exr", 20);
    std::string scene = scene_with_ball(0.2, 0.9);
    const std::string constant = R"({"constant": [1, 1, 1]})";
    scene.replace(scene.find(constant), constant.size(), R"({"file": "sky.exr"})");
    test::write_file(folder / "scene.json", scene);
    const std::string warning = "1 texels were not finite";
    const Outcome recorded =
        test::run_program("record " + (folder / "scene.json").string() + " --out " +
                          (folder / "recording").string() + " --samples 2 --length 1 --truth none");
    ASSERT_EQ(recorded.code, 0) << recorded.err;
    EXPECT_THAT(recorded.err, HasSubstr(warning));
    const Outcome measured = accuracy(folder / "scene.json", folder / "out");
    ASSERT_EQ(measured.code, 0) << measured.err;
    EXPECT_THAT(measured.err, HasSubstr(warning));
}

TEST(Accuracy, RefusesTruthOfAnotherSize) {
    const TemporaryFolder folder;
    fs::copy(ball(), folder / "ball", fs::copy_options::recursive);
    const Image<Rgb> small(16, 12, Rgb(0.5f));
    ExrFile exr;
    exr.picture = &small;
    write_exr(folder / "ball/truth/composite/000002.exr", exr);
    const Outcome outcome = accuracy(folder / "ball", folder / "out");
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("truth/composite/000002.exr"), HasSubstr("16 x 12"),
                                   HasSubstr("32 x 24")));
}

TEST(Accuracy, MeasuresARecordingOfOneFrame) {
    const TemporaryFolder folder;
    const fs::path recording =
        record_ball(folder, scene_with_ball(0.2, 0.9), "--length 1 --truth 0");
    const json work = work_of(recording, folder / "out");
    EXPECT_THAT(work["cells"], SizeIs(6));
    for (const json& cell : work["cells"])
        EXPECT_EQ(cell["temporal"], false);  // there is no frame before
    EXPECT_THAT(figures(work, "truth", "rmse_influenced"), Each(IsFiniteNumber()));
}

TEST(Accuracy, HasNoInfluencedFiguresWhereNothingVirtualIsInView) {
    const TemporaryFolder folder;
    const fs::path recording =
        record_ball(folder, scene_with_ball(0.1, -9), "--length 2 --truth 0,1");
    const json work = work_of(recording, folder / "out");
    for (const char* reference : {"converged", "truth"}) {
        EXPECT_THAT(figures(work, reference, "rmse_influenced"), Each(IsNull()));
        EXPECT_THAT(figures(work, reference, "rmse"), Each(IsFiniteNumber()));
    }
    for (const json& cell : work["cells"])
        EXPECT_TRUE(cell["flicker"].is_null());
    EXPECT_THAT(work["equal_error"], IsEmpty());
}

TEST(Accuracy, MeasuresPicturesThatAreVirtualAllOver) {
    const TemporaryFolder folder;
    const fs::path recording =
        record_ball(folder, scene_with_ball(10, 1), "--length 2 --truth 0,1");
    const json work = work_of(recording, folder / "out");
    ASSERT_THAT(work["cells"], SizeIs(9));
    // every pixel is influenced, so that the two figures are one
    EXPECT_EQ(figures(work, "truth", "rmse"), figures(work, "truth", "rmse_influenced"));
    EXPECT_THAT(figures(work, "truth", "rmse_influenced"), Each(IsFiniteNumber()));
}

TEST(Accuracy, LeavesOutAndCountsPixelsOfTheTruthThatAreNotFinite) {
    const TemporaryFolder folder;
    fs::copy(ball(), folder / "ball", fs::copy_options::recursive);
    spoil(folder / "ball/truth/composite/000001.exr", 40);
    const Outcome outcome = accuracy(folder / "ball", folder / "out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("1 pixels of frame 1's truth are not finite"));
    const json work = report_of(folder / "out")["works"][0];
    for (const char* name : {"rmse", "rmse_influenced", "psnr", "ssim", "flip"})
        EXPECT_THAT(figures(work, "truth", name), Each(IsFiniteNumber())) << name;
    for (const json& stage : work["blame"])
        EXPECT_THAT(stage["swapped_rmse"], IsFiniteNumber()) << stage;
}

TEST(Accuracy, NamesTheNearestMethod) {
    const TemporaryFolder folder;
    const Outcome outcome = accuracy(ball(), folder / "out", "--only axis_alined");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("'axis_alined'"), HasSubstr("'axis_aligned'")));
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace inlay
