// `inlay reconstruct` as its user meets it.
#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>

#include <sstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::Outcome;
using test::TemporaryFolder;

TEST(Reconstruct, WritesAStatusAndAPoseForEveryFrame) {
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder), out = folder / "out";
    test::write_depth(recording / "depth/000002.png", 96, 72, 0);
    const Outcome outcome = test::run_program("reconstruct " + recording.string() + " --out " +
                                              out.string() + " --slam fast --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    std::istringstream text(test::file_text(out / "status.jsonl"));
    std::vector<double> times;
    std::vector<std::string> lost;
    for (std::string line; std::getline(text, line);) {
        const auto status = json::parse(line);
        times.push_back(status["time_s"]);
        if (status["status"] == "lost") lost.push_back(status["frame"].dump());
        EXPECT_EQ(status["why"] == "", status["status"] == "tracked");
    }
    EXPECT_EQ(times.size(), 6u);
    ASSERT_FALSE(lost.empty());
    EXPECT_EQ(lost.front(), "2");
    std::istringstream poses(test::file_text(out / "poses.txt"));
    std::size_t found = 0;
    for (std::string line; std::getline(poses, line);) {
        if (line.starts_with("#")) continue;
        ASSERT_LT(found, times.size());
        EXPECT_NEAR(std::stod(line), times[found++], 1e-5);  // stamps have 6 digits
    }
    EXPECT_EQ(found, 6u);
    EXPECT_TRUE(fs::exists(out / "keyframes.json"));
    EXPECT_TRUE(fs::exists(out / "mesh.ply"));
}

TEST(Reconstruct, LooksAheadAndGoesAroundADamagedFrame) {
    const TemporaryFolder folder;
    const fs::path recording = test::copy_of_recording(folder), out = folder / "out";
    const fs::path damaged = recording / "depth/000002.png";
    fs::resize_file(damaged, fs::file_size(damaged) / 2);
    const Outcome outcome = test::run_program("reconstruct " + recording.string() + " --out " +
                                              out.string() + " --quiet");
    EXPECT_EQ(outcome.code, 65);
    EXPECT_THAT(outcome.err, testing::HasSubstr("depth/000002.png"));
    std::istringstream text(test::file_text(out / "status.jsonl"));
    int lines = 0;
    for (std::string line; std::getline(text, line); ++lines) {
        const auto status = json::parse(line);
        EXPECT_EQ(status["status"] == "lost", status["frame"] == 2) << line;
    }
    EXPECT_EQ(lines, 6);
    const std::string status = test::file_text(out / "status.jsonl");
    const std::string poses = test::file_text(out / "poses.txt");
    const Outcome again = test::run_program("reconstruct " + recording.string() + " --out " +
                                            out.string() + " --quiet");
    EXPECT_EQ(again.code, 65);  // from what was kept
    EXPECT_EQ(test::file_text(out / "status.jsonl"), status);
    EXPECT_EQ(test::file_text(out / "poses.txt"), poses);
}

}  // namespace
}  // namespace inlay
