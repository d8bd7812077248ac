// `--report` of `inlay replay` and `inlay render`: one page that holds what the run's files say.
#include "composite/accuracy/report_pictures.h"
#include "composite/write/write_png.h"
#include "recordings/readers/image_files.h"
#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::replay;
using test::TemporaryFolder;
using test::tiny_recording;
using test::tiny_scene;
using testing::ElementsAre;
using testing::SizeIs;
using testing::StartsWith;

/// What a browser takes for the page's data.
json data_of(const fs::path& page) {
    const std::string text = test::file_text(page);
    const std::string open = R"(<script type="application/json" id="data">)";
    const std::size_t begin = text.find(open) + open.size();
    const json data = json::parse(text.substr(begin, text.find("</script>", begin) - begin),
                                  nullptr, /*allow_exceptions=*/false);
    EXPECT_TRUE(data.is_object()) << page;
    return data.is_object() ? data : json::object();
}

/// The lines of frames.jsonl by the numbers of their frames.
std::vector<json> sorted_lines(const fs::path& run) {
    std::vector<json> lines;
    std::istringstream text(test::file_text(run / "frames.jsonl"));
    for (std::string line; std::getline(text, line);)
        lines.push_back(json::parse(line));
    std::sort(lines.begin(), lines.end(),
              [](const json& a, const json& b) { return a["frame"] < b["frame"]; });
    return lines;
}

std::string shown(const Image<EncodedRgb>& picture) { return data_url(encode_png(picture)); }

Image<EncodedRgb> four_times_the_difference(const Image<EncodedRgb>& a,
                                            const Image<EncodedRgb>& b) {
    Image<EncodedRgb> result(a.width, a.height);
    const auto far = [](int x, int y) { return std::uint8_t(std::min(255, 4 * std::abs(x - y))); };
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        result.pixels[i] = {far(a.pixels[i].r, b.pixels[i].r), far(a.pixels[i].g, b.pixels[i].g),
                            far(a.pixels[i].b, b.pixels[i].b)};
    return result;
}

void expect_pictures_of_files(const json& page, const fs::path& run,
                              const std::vector<int>& frames) {
    ASSERT_THAT(page["pictures"], SizeIs(3 * frames.size()));
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string name = "00000" + std::to_string(frames[i]) + ".png";
        const auto photograph = read_color(tiny_recording() / "rgb" / name);
        const auto composite = read_color(run / "frames" / name);
        const std::vector<json> expected{
            {{"frame", frames[i]}, {"title", "photograph"}, {"png", shown(photograph)}},
            {{"frame", frames[i]}, {"title", "composite"}, {"png", shown(composite)}},
            {{"frame", frames[i]},
             {"title", "difference"},
             {"png", shown(four_times_the_difference(photograph, composite))}}};
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_TRUE(page["pictures"][3 * i + k] == expected[k])
                << name << " " << expected[k]["title"];
    }
}

TEST(Report, HoldsWhatTheFilesOfAReplaySay) {
    const TemporaryFolder folder;
    const fs::path run = folder / "out";
    const Outcome outcome = replay(tiny_recording(), tiny_scene(), run, "--report");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(test::file_text(run / "report.html"), StartsWith("<!doctype html>"));
    const json page = data_of(run / "report.html");
    const json described = json::parse(test::file_text(run / "run.json"));
    EXPECT_EQ(page["version"], 1);
    EXPECT_EQ(page["kind"], "replay");
    EXPECT_EQ(page["command"], "replay");
    EXPECT_THAT(sorted_lines(run), SizeIs(6));
    EXPECT_EQ(page["frames"], json(sorted_lines(run)));
    EXPECT_EQ(page["settings"], described["settings"]);
    EXPECT_EQ(page["plan"], described["plan"]);
    EXPECT_EQ(page["program"], described["version"]);
    EXPECT_EQ(page["recording"], described["recording"]["name"]);
    EXPECT_EQ(page["scene"], described["scene"]["name"]);
    EXPECT_GE(page["machine"]["threads"], 1);
    expect_pictures_of_files(page, run, {0, 3, 5});
}

TEST(Report, HoldsTheFramesOfEarlierRunsInTheirOrder) {
    const TemporaryFolder folder;
    const fs::path run = folder / "out";
    ASSERT_EQ(replay(tiny_recording(), tiny_scene(), run, "--shard 2/2").code, 0);
    EXPECT_FALSE(fs::exists(run / "report.html"));
    const Outcome outcome =
        replay(tiny_recording(), tiny_scene(), run, "--shard 1/2 --resume --report");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json page = data_of(run / "report.html");
    std::vector<int> frames;
    for (const json& frame : page["frames"])
        frames.push_back(frame["frame"]);
    EXPECT_THAT(frames, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_EQ(page["frames"], json(sorted_lines(run)));
    expect_pictures_of_files(page, run, {0, 3, 5});
}

TEST(Report, OfOneFrameShowsItOnce) {
    const TemporaryFolder folder;
    const fs::path run = folder / "out";
    const Outcome outcome = replay(tiny_recording(), tiny_scene(), run, "--frames 2 --report");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    expect_pictures_of_files(data_of(run / "report.html"), run, {2});
}

TEST(Report, OfARenderStandsBesideThePicture) {
    const TemporaryFolder folder;
    test::write_file(folder / "ball.json",
                     R"({"version": 1, "environment": {"constant": [1, 1, 1]},
  "view": {"width": 32, "height": 24, "lens": [30, 30, 15.5, 11.5],
           "world_from_camera": [1,0,0,0, 0,-1,0,0, 0,0,-1,1, 0,0,0,1]},
  "objects": [{"name": "ball", "sphere": {"radius": 0.2},
               "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})");
    const Outcome outcome = test::run_program("render " + (folder / "ball.json").string() +
                                              " --out " + (folder / "ball.png").string() +
                                              " --samples 4 --photo-samples 4 --quiet --report");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json page = data_of(folder / "ball.html");
    EXPECT_EQ(page["command"], "render");  // the page's heading says so
    EXPECT_EQ(page["recording"], "the view of ball");
    ASSERT_THAT(page["frames"], SizeIs(1));
    EXPECT_EQ(page["frames"][0]["tracking"], "tracked");
    EXPECT_GT(page["frames"][0]["pixels"]["virtual"], 0);
    EXPECT_GT(page["frames"][0]["rays"]["primary"], 0);
    ASSERT_THAT(page["pictures"], SizeIs(3));
    EXPECT_TRUE(page["pictures"][1]["png"] == shown(read_color(folder / "ball.png")));
}

}  // namespace
}  // namespace inlay
