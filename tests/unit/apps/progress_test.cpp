// Progress lines and interruption.
#include "apps/inlay/progress.h"

#include "apps/inlay/interrupt.h"
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>

namespace inlay {
namespace {

std::string said(int total, bool quiet) {
    testing::internal::CaptureStderr();
    {
        Progress progress("reading frames", total, quiet);
        for (int done = 1; done <= total; ++done)
            progress.advance_to(done);
    }
    return testing::internal::GetCapturedStderr();
}

TEST(Progress, WithoutATerminalSaysEveryTenthOnALineOfItsOwn) {
    const std::string text = said(250, false);
    EXPECT_EQ(std::ranges::count(text, '\n'), 10);
    EXPECT_NE(text.find("reading frames 25/250\n"), std::string::npos) << text;
    EXPECT_NE(text.find("reading frames 250/250\n"), std::string::npos) << text;
    EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, QuietSaysNothing) { EXPECT_EQ(said(250, true), ""); }

TEST(Progress, AFewStepsAreSaidOnce) {
    const std::string text = said(3, false);
    EXPECT_EQ(std::ranges::count(text, '\n'), 3);
}

TEST(InterruptDeathTest, TheFirstSignalAsksTheSecondKills) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const auto first = [] {
        catch_interrupts();
        const bool before = interrupted();
        std::raise(SIGINT);
        std::_Exit(!before && interrupted() ? 130 : 1);
    };
    EXPECT_EXIT(first(), testing::ExitedWithCode(130), "");
    const auto second = [] {
        catch_interrupts();
        std::raise(SIGINT);
        std::raise(SIGINT);
    };
    EXPECT_EXIT(second(), testing::KilledBySignal(SIGINT), "");
}

}  // namespace
}  // namespace inlay
