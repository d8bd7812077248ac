// Frame lists of the command line.
#include "apps/inlay/frame_list.h"

#include "recordings/base/check.h"

#include <gmock/gmock.h>

namespace inlay {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(FrameList, ContainsWhatItSays) {
    const FrameList list = parse_frames("0-9x3,150,20-21");
    std::vector<int> frames;
    for (int i = 0; i < 300; ++i)
        if (list.contains(i)) frames.push_back(i);
    EXPECT_THAT(frames, ElementsAre(0, 3, 6, 9, 20, 21, 150));
}

TEST(FrameList, AllIsEveryFrame) {
    for (const char* text : {"", "all"})
        EXPECT_TRUE(parse_frames(text).contains(123456)) << text;
}

TEST(FrameList, SelectsFromTheRecordingsOwnNumbers) {
    const std::vector<int> available{5, 10, 11, 40};
    EXPECT_THAT(select_frames(parse_frames("0-11"), available), ElementsAre(5, 10, 11));
    EXPECT_THROW(select_frames(parse_frames("12-39"), available), Error);
    EXPECT_THROW(select_frames(parse_frames("all"), {}), Error);
}

TEST(FrameList, RefusalsAreUsageErrorsThatNameTheItem) {
    for (const char* bad : {"-", "3-", "-3", "5-2", "0-9x0", "0-9x", "a", "1,,2", "1,", "0x2",
                            "1-2-3", "1.5", "99999999999", " 1", "0-9x-1"}) {
        try {
            parse_frames(bad);
            ADD_FAILURE() << "accepted '" << bad << "'";
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::usage) << bad;
            EXPECT_THAT(error.what(), HasSubstr("expected")) << bad;
        }
    }
}

}  // namespace
}  // namespace inlay
