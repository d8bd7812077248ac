// `inlay replay` as its user meets it: the same bytes whatever way a frame is reached, and what a
// run leaves behind.
#include "composite/write/frame_report.h"
#include "recordings/readers/image_files.h"
#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::contents;
using test::Outcome;
using test::pictures;
using test::replay;
using test::run_program;
using test::TemporaryFolder;
using test::tiny_recording;
using test::tiny_scene;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

const std::string tracked = "--layers all ";
const std::string posed = tracked + "--poses recorded ";

/// All frames of the tiny recording, made once for each set of options.
const fs::path& whole_run(const std::string& options) {
    static const TemporaryFolder folder;
    static std::map<std::string, fs::path> runs;
    const auto [run, fresh] = runs.try_emplace(options);
    if (fresh) {
        run->second = folder / std::to_string(runs.size());
        const Outcome outcome =
            replay(tiny_recording(), tiny_scene(), run->second, options + "--threads 2");
        if (outcome.code != 0) throw std::runtime_error("cannot replay: " + outcome.err);
    }
    return run->second;
}

std::vector<json> lines_of(const fs::path& run) {
    std::vector<json> lines;
    std::istringstream text(test::file_text(run / "frames.jsonl"));
    for (std::string line; std::getline(text, line);)
        lines.push_back(json::parse(line));
    return lines;
}

std::vector<std::string> keys(const json& object) {
    std::vector<std::string> names;
    for (const auto& item : object.items())
        names.push_back(item.key());
    return names;
}

bool has_recorded_pixels(const fs::path& run, const std::string& name) {
    return read_color(run / "frames" / name).pixels ==
           read_color(tiny_recording() / "rgb" / name).pixels;
}

TEST(Replay, GivesTheSameBytesForAnyNumberOfThreads) {
    for (const std::string& options : {tracked, posed}) {
        const TemporaryFolder folder;
        const fs::path& whole = whole_run(options);
        const Outcome outcome =
            replay(tiny_recording(), tiny_scene(), folder / "out", options + "--threads 1");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(pictures(whole), SizeIs(12));
        EXPECT_TRUE(pictures(folder / "out") == pictures(whole)) << options;
    }
}

TEST(Replay, GivesTheSameBytesTwice) {
    const TemporaryFolder folder;
    const Outcome outcome =
        replay(tiny_recording(), tiny_scene(), folder / "out", posed + "--threads 2");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(pictures(folder / "out") == pictures(whole_run(posed)));
    const Outcome compared = run_program("compare --json " + (folder / "out/frames").string() +
                                         " " + (whole_run(posed) / "frames").string());
    EXPECT_EQ(compared.code, 0) << compared.err;
    EXPECT_THAT(compared.out, HasSubstr("\"rmse\": 0.0"));
}

TEST(Replay, ChangesTheRecordedPicture) {  // or equal bytes would say nothing
    EXPECT_FALSE(has_recorded_pixels(whole_run(posed), "000003.png"));
    EXPECT_FALSE(has_recorded_pixels(whole_run(tracked), "000000.png"));
}

TEST(Replay, MakesOneFrameAsInTheWholeRun) {
    for (const std::string& options : {tracked, posed}) {
        const TemporaryFolder folder;
        const Outcome outcome =
            replay(tiny_recording(), tiny_scene(), folder / "out", options + "--frames 3");
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const auto one = pictures(folder / "out"), all = pictures(whole_run(options));
        ASSERT_THAT(one, SizeIs(2));
        for (const auto& [name, bytes] : one)
            EXPECT_TRUE(all.at(name) == bytes) << name << " " << options;
    }
}

TEST(Replay, ShardsTogetherAreTheWhole) {
    const TemporaryFolder folder;
    for (const char* shard : {"1/2", "2/2"}) {
        const Outcome outcome = replay(tiny_recording(), tiny_scene(), folder / "out",
                                       posed + "--resume --shard " + shard);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(pictures(folder / "out"), SizeIs(shard[0] == '1' ? 6 : 12));
    }
    EXPECT_TRUE(pictures(folder / "out") == pictures(whole_run(posed)));
}

TEST(Replay, LeavesTheRecordingAloneWithoutObjects) {
    const TemporaryFolder folder;
    test::write_file(folder / "empty.json",
                     R"({"version": 1, "environment": {"constant": [1, 1, 1]}, "objects": []})");
    const Outcome outcome = replay(tiny_recording(), folder / "empty.json", folder / "out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (int frame = 0; frame < 6; ++frame)
        EXPECT_TRUE(has_recorded_pixels(folder / "out", "00000" + std::to_string(frame) + ".png"));
}

TEST(Replay, LeavesTheRecordingAloneWhereTrackingIsLost) {
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder);
    test::write_depth(recording / "depth/000002.png", 96, 72, 0);
    const Outcome outcome = replay(recording, tiny_scene(), folder / "out");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::vector<json> lines = lines_of(folder / "out");
    ASSERT_THAT(lines, SizeIs(6));
    EXPECT_EQ(lines[2]["tracking"], "lost");
    EXPECT_EQ(lines[2]["pixels"]["influenced"], 0);
    EXPECT_TRUE(has_recorded_pixels(folder / "out", "000002.png"));
}

TEST(Replay, WithRecordedPosesShowsThePhotographWhereOneIsMissing) {
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder);
    std::istringstream poses(test::file_text(recording / "groundtruth.txt"));
    std::string kept;
    int number = 0;
    for (std::string line; std::getline(poses, line);)
        if (line.starts_with("#") || number++ < 5) kept += line + "\n";
    test::write_file(recording / "groundtruth.txt", kept);
    const Outcome outcome =
        run_program("replay " + recording.string() + " --scene " + tiny_scene().string() +
                    " --out " + (folder / "out").string() +
                    " --samples 4 --poses recorded"
                    " --set slam.fusion.voxel_size=0.02"
                    " --set slam.fusion.truncation=0.08");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr("1 of 6 frames have no usable recorded pose"));
    const std::vector<json> lines = lines_of(folder / "out");
    ASSERT_THAT(lines, SizeIs(6));
    for (std::size_t i = 0; i < lines.size(); ++i)
        EXPECT_EQ(lines[i]["tracking"], i == 5 ? "lost" : "tracked");
    EXPECT_TRUE(has_recorded_pixels(folder / "out", "000005.png"));
    EXPECT_FALSE(has_recorded_pixels(folder / "out", "000004.png"));
}

TEST(Replay, AddsUpTheTimesOfAllStages) {
    const TemporaryFolder folder;
    const Outcome outcome =
        replay(tiny_recording(), tiny_scene(), folder / "out", "--frames 0 --json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const json totals = json::parse(outcome.out);
    double sum = 0;
    for (const char* stage : {"load", "slam", "plan", "trace", "filter", "composite", "write"})
        sum += totals["mean_ms"][stage].get<double>();
    EXPECT_NEAR(sum, totals["mean_ms"]["total"].get<double>(), 1e-6);
    EXPECT_EQ(totals["dropped_samples"], 0);
    EXPECT_EQ(totals["replaced_pixels"], 0);
}

TEST(Replay, ReportsEveryFrameInALine) {
    const std::vector<json> lines = lines_of(whole_run(posed));
    ASSERT_THAT(lines, SizeIs(6));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const json& line = lines[i];
        // in alphabetical order, as the parser keeps them
        EXPECT_THAT(keys(line),
                    ElementsAre("dropped_samples", "frame", "ms", "pixels", "plan", "rays",
                                "replaced_pixels", "time_s", "tracking", "world_from_camera"));
        EXPECT_THAT(keys(line["ms"]), ElementsAre("composite", "filter", "load", "plan", "slam",
                                                  "total", "trace", "write"));
        EXPECT_THAT(keys(line["rays"]), ElementsAre("primary", "real_indirect", "real_shadow",
                                                    "virtual_indirect", "virtual_shadow"));
        EXPECT_THAT(keys(line["pixels"]), ElementsAre("influenced", "skipped", "virtual"));
        EXPECT_EQ(line["frame"], i);
        EXPECT_NEAR(line["time_s"].get<double>(), double(i) / 30, 1e-6);  // stamps have 6 digits
        EXPECT_THAT(line["world_from_camera"], SizeIs(16));
        EXPECT_GE(line["pixels"]["influenced"], line["pixels"]["virtual"]);
        EXPECT_LE(line["pixels"]["skipped"], 96 * 72);
        EXPECT_THAT(line["plan"], testing::Contains("environment_indirect"));
    }
}

TEST(Replay, DescribesTheRun) {
    const json run = json::parse(test::file_text(whole_run(posed) / "run.json"));
    EXPECT_THAT(run["version"].get<std::string>(), testing::Not(IsEmpty()));
    EXPECT_EQ(run["command"][1], "replay");
    EXPECT_EQ(run["command"][2], tiny_recording().string());
    EXPECT_THAT(run["command"], testing::Contains("--poses"));
    EXPECT_EQ(run["frames"], "all");
    EXPECT_EQ(run["shard"], "");
    EXPECT_EQ(run["assets"], json::array());
    EXPECT_THAT(run["scene"]["files"], testing::Contains(run["scene"]["files"]["vase/vase.png"]));
    EXPECT_EQ(run["settings"]["slam.fusion.voxel_size"], "0.02");
    EXPECT_EQ(run["settings"]["slam.poses"], "recorded");
    EXPECT_EQ(run["recording"]["frames"], 6);
    EXPECT_THAT(run["recording"]["fingerprint"].get<std::string>(), SizeIs(16));
    EXPECT_THAT(run["scene"]["fingerprint"].get<std::string>(), SizeIs(16));
    EXPECT_THAT(run["plan"], SizeIs(15));  // the effects of composite/plan/effect_rules.cpp
    for (const json& effect : run["plan"]) {
        EXPECT_THAT(effect["reason"].get<std::string>(), testing::Not(IsEmpty()));
        EXPECT_THAT(effect["worth"].get<std::string>(), testing::Not(IsEmpty()));
        EXPECT_TRUE(effect["in"].get<bool>() || effect["passes"].empty());
    }
    EXPECT_EQ(run["plan"][1]["effect"], "environment_indirect");
    EXPECT_EQ(run["plan"][1]["rays_per_pixel"]["real_indirect"],
              8);  // --samples 4: as many of E_R, and of exchanged surfaces
}

TEST(Replay, ExplainsAndWritesNothing) {
    const TemporaryFolder folder;
    const Outcome outcome = replay(tiny_recording(), tiny_scene(), folder / "out", "--explain");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("in   environment_direct: "));
    // one of the desk's balls rolls
    EXPECT_THAT(outcome.out, HasSubstr("out  temporal_filter: "));
    EXPECT_EQ(folder.entries(), 0);
}

TEST(Replay, PrintsSettingsWithoutAnyInput) {
    const Outcome printed = run_program("replay --print-settings");
    EXPECT_EQ(printed.code, 0) << printed.err;
    EXPECT_THAT(printed.out, HasSubstr("filter.kernel_radius="));
    EXPECT_EQ(run_program("replay").code, 2);
}

TEST(Replay, TakesEverySettingBackThatItPrints) {
    const TemporaryFolder folder;
    const std::string changed = "--print-settings --seed 7 --set filter.normal_stop_deg=33 ";
    const Outcome printed = replay(tiny_recording(), tiny_scene(), folder / "out", changed);
    ASSERT_EQ(printed.code, 0) << printed.err;
    std::istringstream text(printed.out);
    std::string back;
    int settings = 0;
    for (std::string line; std::getline(text, line); ++settings)
        back += "--set '" + line.substr(0, line.find("  #")) + "' ";
    EXPECT_GT(settings, 30);
    const Outcome again =
        run_program("replay " + tiny_recording().string() + " --scene " + tiny_scene().string() +
                    " --out " + (folder / "out").string() + " --print-settings " + back);
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(again.out, printed.out);
    EXPECT_EQ(folder.entries(), 0);
}

}  // namespace
}  // namespace inlay
