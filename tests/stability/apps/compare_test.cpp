// `inlay compare` as its user meets it.
#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <cstdlib>
#include <limits>

namespace inlay {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;

struct Answer {
    int code = 0;
    std::string text;  // both streams
};

Answer compare(const std::filesystem::path& a, const std::filesystem::path& b,
               const std::string& options = "") {
    const TemporaryFolder folder;
    const std::string command = std::string(INLAY_PROGRAM) + " compare " + a.string() + " " +
                                b.string() + " " + options + " >" + (folder / "out").string() +
                                " 2>&1";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::file_text(folder / "out")};
}

Image<EncodedRgb> grey(int width, std::uint8_t value) {
    return Image<EncodedRgb>(width, 12, {value, value, value});
}

TEST(Compare, FindsEqualPicturesEqual) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", grey(16, 100));
    const Answer answer = compare(folder / "a.png", folder / "a.png", "--json");
    EXPECT_EQ(answer.code, 0) << answer.text;
    EXPECT_THAT(answer.text, HasSubstr("\"rmse\": 0.0"));
    EXPECT_THAT(answer.text, HasSubstr("\"psnr_db\": null"));  // infinite
    EXPECT_THAT(answer.text, HasSubstr("\"flip\": 0.0"));
}

TEST(Compare, PairsFoldersByNameAndListsTheRest) {
    const TemporaryFolder folder;
    for (const char* side : {"a", "b"}) {
        std::filesystem::create_directory(folder / side);
        write_png(folder / side / "000001.png", grey(16, 100));
        write_png(folder / side / "000002.png", grey(16, side[0] == 'a' ? 100 : 116));
    }
    write_png(folder / "a" / "000003.png", grey(16, 1));
    const Answer answer = compare(folder / "a", folder / "b");
    EXPECT_EQ(answer.code, 0);
    EXPECT_THAT(answer.text, HasSubstr("24.05"));  // 20 log10(255 / 16), frame 2
    EXPECT_THAT(answer.text, HasSubstr("27.06"));  // the mean square over two frames is half
    EXPECT_THAT(answer.text, HasSubstr("only in A: 000003.png"));
    EXPECT_THAT(compare(folder / "a", folder / "b", "--frames 2").text,
                Not(HasSubstr("000001.png")));
}

TEST(Compare, KeepsHugeRadianceFinite) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", grey(16, 100));
    const Image<Rgb> huge(16, 12, Rgb(std::numeric_limits<float>::max()));
    // finite in the file, and its square is not finite in float: the figures must be
    write_exr(folder / "b.exr", {.picture = &huge, .picture_precision = ExrPrecision::full_float});
    const Answer answer = compare(folder / "a.png", folder / "b.exr", "--json");
    EXPECT_EQ(answer.code, 0) << answer.text;
    EXPECT_THAT(answer.text, HasSubstr("\"relative_rmse\": 1.0"));
    EXPECT_THAT(answer.text, HasSubstr("\"non_finite\": 0"));
}

TEST(Compare, RefusesWhatCannotBeCompared) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", grey(16, 100));
    write_png(folder / "wide.png", grey(17, 100));
    EXPECT_EQ(compare(folder / "a.png", folder / "wide.png").code, 65);
    EXPECT_THAT(compare(folder / "a.png", folder / "wide.png").text, HasSubstr("17 x 12"));
    EXPECT_EQ(compare(folder / "a.png", folder / "none.png").code, 66);
    EXPECT_EQ(compare(folder / "a.png", folder.path()).code, 2);
    std::filesystem::create_directory(folder / "empty");
    EXPECT_EQ(compare(folder.path(), folder / "empty").code, 66);
}

}  // namespace
}  // namespace inlay
