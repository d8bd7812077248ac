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

TEST(Reconstruct, WritesAStatusForEveryFrameAndAPoseForThoseThatHaveOne) {
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
        const json status = json::parse(line);
        if (status["in_poses_txt"]) times.push_back(status["time_s"]);
        if (status["status"] == "lost") lost.push_back(status["frame"].dump());
        EXPECT_EQ(status["in_poses_txt"].get<bool>(), status["status"] != "lost");
    }
    ASSERT_FALSE(lost.empty());
    EXPECT_EQ(lost.front(), "2");
    EXPECT_EQ(times.size() + lost.size(), 6u);
    std::istringstream poses(test::file_text(out / "poses.txt"));
    std::size_t found = 0;
    for (std::string line; std::getline(poses, line);) {
        if (line.starts_with("#")) continue;
        ASSERT_LT(found, times.size());
        EXPECT_NEAR(std::stod(line), times[found++], 1e-5);  // stamps have 6 digits
    }
    EXPECT_EQ(found, times.size());
    EXPECT_GE(found, 2u);
}

}  // namespace
}  // namespace inlay
