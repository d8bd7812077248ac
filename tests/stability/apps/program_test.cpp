// The program as its user meets it: exit codes, and what goes to which stream.
#include "tests/support/recording_folders.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>

namespace inlay {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using testing::IsEmpty;

struct Outcome {
    int code = 0;
    std::string out, err;
};

Outcome run_program(const std::string& arguments) {
    TemporaryFolder folder;
    const std::string command = std::string(INLAY_PROGRAM) + " " + arguments + " >" +
                                (folder / "out").string() + " 2>" + (folder / "err").string();
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::file_text(folder / "out"),
            test::file_text(folder / "err")};
}

TEST(Program, HelpAndVersionAreSuccess) {
    for (const char* arguments : {"--help", "info --help", "--version"}) {
        const Outcome outcome = run_program(arguments);
        EXPECT_EQ(outcome.code, 0) << arguments;
        EXPECT_THAT(outcome.out, HasSubstr("inlay")) << arguments;
        EXPECT_THAT(outcome.err, IsEmpty()) << arguments;
    }
}

TEST(Program, WrongUsageIsTwo) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0});
    const std::string recording = folder.path().string();
    for (const std::string& arguments : std::vector<std::string>{
             "", "nonsense", "info", "info --nonsense " + recording,
             "info --threads -1 " + recording, "info --frames 3- " + recording,
             "info --frames 7 " + recording, "info --lens 1,2,3 " + recording,
             "info --lens a,b,c,d " + recording, "info --depth-scale 0 " + recording,
             "info --profile kinect " + recording}) {
        const Outcome outcome = run_program(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments;
        EXPECT_THAT(outcome.err, HasSubstr("inlay: ")) << arguments;
        EXPECT_THAT(outcome.out, IsEmpty()) << arguments;
    }
}

TEST(Program, InfoTellsMissingFromBad) {
    TemporaryFolder folder;
    EXPECT_EQ(run_program("info " + (folder / "none").string()).code, 66);
    EXPECT_EQ(run_program("info " + folder.path().string()).code, 65);
}

TEST(Program, InfoPrintsWhatItFoundAndAssumed) {
    TemporaryFolder folder;
    test::write_three_d_match(folder.path(), {0, 1, 2, 3});
    const Outcome outcome =
        run_program("info " + folder.path().string() + " --distortion -0.1,0,0,0,0");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* text : {"3dmatch recording, 4 frames (0 to 3), 64 x 48 px", "-0.1 0 0 0 0",
                             "synthetic", "4 of 4 frames", "as opened", "poses inverted"})
        EXPECT_THAT(outcome.out, HasSubstr(text));
    const Outcome json = run_program("info --json " + folder.path().string());
    EXPECT_EQ(json.out.front(), '{');
    EXPECT_THAT(json.out, HasSubstr("\"profile\": \"3dmatch\""));
}

TEST(Program, AFullDiskIsNotSuccess) {
    const std::string command = std::string(INLAY_PROGRAM) + " --help >/dev/full 2>/dev/null";
    EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 74);
}

}  // namespace
}  // namespace inlay
