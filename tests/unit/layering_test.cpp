// The layers as data: which folder may include which. Every #include "..." of the libraries is
// read.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>

namespace fs = std::filesystem;

namespace {

const std::map<std::string, std::set<std::string>> may_include{
    {"recordings/base", {"recordings/base"}},
    {"recordings", {"recordings", "recordings/base"}},
    {"slam", {"slam", "recordings/base"}},
    {"render", {"render", "recordings", "recordings/base"}},
    {"composite", {"composite", "recordings", "recordings/base", "slam", "render"}}};

std::string layer_of(const std::string& path) {
    if (path.starts_with("recordings/base/")) return "recordings/base";
    return path.substr(0, path.find('/'));
}

TEST(Layering, EveryIncludeStaysWithinItsLayer) {
    const fs::path root = INLAY_SOURCE_DIR;
    const std::regex include(R"re(^\s*#include "([^"]+)")re");
    int includes = 0;
    for (const char* top : {"recordings", "slam", "render", "composite"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            const std::string from = fs::relative(entry.path(), root).generic_string();
            std::ifstream file(entry.path());
            for (std::string line; std::getline(file, line);) {
                std::smatch match;
                if (!std::regex_search(line, match, include)) continue;
                ++includes;
                EXPECT_TRUE(may_include.at(layer_of(from)).contains(layer_of(match[1])))
                    << from << " includes " << match[1];
            }
        }
    }
    EXPECT_GT(includes, 0) << "no include was read: is INLAY_SOURCE_DIR right?";
}

}  // namespace
