// The committed default recording is what `inlay record desk` makes today: one frame again, byte by
// byte. If this fails on purpose, the recording is made anew in a commit of its own.
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdlib>
#include <fstream>
#include <string>

namespace inlay {
namespace {

TEST(DefaultRecordingBytes, OneFrameIsMadeAgain) {
    const std::filesystem::path committed =
        std::filesystem::path(INLAY_SOURCE_DIR) / "apps" / "demo" / "recording";
    std::ifstream stream(committed / "record.json");
    const nlohmann::json how = nlohmann::json::parse(stream);
    std::ifstream camera_stream(committed / "camera.json");
    const nlohmann::json camera = nlohmann::json::parse(camera_stream);
    test::TemporaryFolder folder;
    const std::string out = (folder / "again").string();
    const std::string size = std::to_string(camera["width"].get<int>()) + "x" +
                             std::to_string(camera["height"].get<int>());
    const std::string command = std::string(INLAY_PROGRAM) + " record desk --quiet --truth none" +
                                " --frames 12 --length " + how["frames"].dump() + " --samples " +
                                how["samples"].dump() + " --size " + size + " --out " + out;
    ASSERT_EQ(std::system(command.c_str()), 0);
    for (const char* file : {"rgb/000012.png", "depth/000012.png", "camera.json", "rgb.txt",
                             "groundtruth.txt", "scene.json", "truth/environment.exr"})
        EXPECT_EQ(test::file_text(out + "/" + file), test::file_text(committed / file)) << file;
}

}  // namespace
}  // namespace inlay
