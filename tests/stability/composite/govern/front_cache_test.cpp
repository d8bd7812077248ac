// Kept fronts: what comes back, and files that nobody should believe.
#include "composite/govern/front_cache.h"

#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

namespace fs = std::filesystem;

const PriceFront front{{{4, 30.5, 0.04}, {16, 90.25, 0.02}}, 40.125};

fs::path only_file(const fs::path& folder) { return fs::directory_iterator(folder)->path(); }

TEST(FrontCache, WhatWasKeptComesBackToTheBit) {
    const test::TemporaryFolder folder;
    keep_front(folder / "new" / "folder", "key", front);
    const auto kept = kept_front(folder / "new" / "folder", "key");
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->other_ms, front.other_ms);
    ASSERT_EQ(kept->points.size(), 2U);
    EXPECT_EQ(kept->points[1].samples, 16);
    EXPECT_EQ(kept->points[1].ms, 90.25);
    EXPECT_EQ(kept->points[1].error, 0.02);
    EXPECT_FALSE(kept_front(folder / "new" / "folder", "another key"));
}

TEST(FrontCache, AFileThatCannotBeUnderstoodCountsAsNone) {
    const test::TemporaryFolder folder;
    keep_front(folder / ".", "key", front);
    const fs::path file = only_file(folder / ".");
    for (const char* text :
         {"", "{", "[]", "{\"key\": \"key\"}",
          R"({"key": "other", "other_ms": 1, "points": [{"samples": 4, "ms": 1, "error": 1}]})",
          R"({"key": "key", "other_ms": 1, "points": []})",
          R"({"key": "key", "other_ms": -1, "points": [{"samples": 4, "ms": 1, "error": 1}]})",
          R"({"key": "key", "other_ms": 1, "points": [{"samples": 0, "ms": 1, "error": 1}]})",
          R"({"key": "key", "other_ms": 1, "points": [{"samples": 4, "ms": 1e999, "error": 1}]})",
          R"({"key": "key", "other_ms": 1, "points": [{"samples": 4, "ms": 9, "error": 1},
                                                       {"samples": 8, "ms": 3, "error": 2}]})"}) {
        write_text(file, text);
        EXPECT_FALSE(kept_front(folder / ".", "key")) << text;
    }
}

TEST(FrontCache, AFolderThatCannotBeMadeIsAnError) {
    const test::TemporaryFolder folder;
    write_text(folder / "file", "");
    EXPECT_THROW(keep_front(folder / "file" / "below", "key", front), Error);
}

}  // namespace
}  // namespace inlay
