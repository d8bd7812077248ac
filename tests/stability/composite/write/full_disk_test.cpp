// A full disk, played by a limit on file sizes: the error says so, nothing half-written appears
// under the final name, and what stood there before stays.
#include "composite/write/atomic_file.h"
#include "composite/write/frame_report.h"
#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "composite/write/write_video.h"
#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cstdlib>
#include <functional>
#include <optional>

namespace inlay {
namespace {

using test::file_text;
using test::TemporaryFolder;

/// While it lives, no file of this process and its children may grow beyond `bytes`.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) {
        old_handler_ = ::signal(SIGXFSZ, SIG_IGN);
        ::getrlimit(RLIMIT_FSIZE, &old_limit_);
        const rlimit limit{bytes, old_limit_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_limit_);
        ::signal(SIGXFSZ, old_handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    rlimit old_limit_{};
    sighandler_t old_handler_ = SIG_DFL;
};

constexpr rlim_t limit_bytes = 20'000;

Image<Rgb> noise(int width, int height) {
    Image<Rgb> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const SampleKey key{.pixel = std::uint32_t(i)};
        image.pixels[i] = {uniform(key, 0), uniform(key, 1), uniform(key, 2)};
    }
    return image;
}

/// The code of the Error that `write` throws, once the disk is full.
std::optional<ExitCode> code_on_full_disk(const std::function<void()>& write) {
    const FileSizeLimit limit(limit_bytes);
    try {
        write();
    } catch (const Error& e) {
        return e.code();
    }
    return std::nullopt;
}

/// Writes a small file, then lets `write` replace it on a full disk.
void expect_old_file_survives(const std::function<void(const std::filesystem::path&)>& write) {
    const TemporaryFolder folder;
    const auto file = folder / "out";
    write_png(file, Image<EncodedRgb>(4, 4));
    const std::string before = file_text(file);
    EXPECT_EQ(code_on_full_disk([&] { write(file); }), ExitCode::disk_fault);
    EXPECT_TRUE(file_text(file) == before);
    EXPECT_EQ(folder.entries(), 1);
}

TEST(FullDisk, PngLeavesTheOldFile) {
    const Image<EncodedRgb> picture = encode(noise(200, 200));
    expect_old_file_survives([&](const auto& file) { write_png(file, picture); });
}

TEST(FullDisk, ExrLeavesTheOldFile) {
    const Image<Rgb> picture = noise(200, 200);
    expect_old_file_survives([&](const auto& file) { write_exr(file, {.picture = &picture}); });
}

TEST(FullDisk, VideoLeavesTheOldFile) {
    const Image<EncodedRgb> picture = encode(noise(200, 200));
    expect_old_file_survives([&](const auto& file) {
        VideoWriter video(file, 200, 200);
        for (int i = 0; i < 10; ++i)
            video.write(picture);
        video.close();
    });
}

TEST(FullDisk, NothingAppearsUnderANewName) {
    const TemporaryFolder folder;
    const Image<EncodedRgb> picture = encode(noise(200, 200));
    EXPECT_EQ(code_on_full_disk([&] { write_png(folder / "a.png", picture); }),
              ExitCode::disk_fault);
    EXPECT_EQ(folder.entries(), 0);
}

TEST(FullDisk, ReportsKeepTheirCompleteLines) {
    const TemporaryFolder folder;
    const auto file = folder / "frames.jsonl";
    const std::optional<ExitCode> code = code_on_full_disk([&] {
        for (int frame = 0; frame < 1000; ++frame)
            append_report(file, {.frame = frame});
    });
    EXPECT_EQ(code, ExitCode::disk_fault);
    const std::string text = file_text(file);
    EXPECT_EQ(text.back(), '\n');
    const std::vector<FrameReport> reports = read_reports(file);
    ASSERT_GT(reports.size(), 10u);
    EXPECT_LT(reports.size(), 1000u);
    append_report(file, {.frame = 5000});  // and with space again the run goes on
    EXPECT_EQ(read_reports(file).back().frame, 5000);
    EXPECT_EQ(read_reports(file).size(), reports.size() + 1);
}

TEST(FullDisk, TheProgramExitsWithSeventyFour) {
    EXPECT_EQ(int(ExitCode::disk_fault), 74);
    try {
        throw_write_error("out/frames/000001.png", ENOSPC);
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::disk_fault);
        EXPECT_NE(std::string(e.what()).find("No space left"), std::string::npos) << e.what();
    }
}

TEST(UnwritableFolder, IsAnotherErrorThanAFullDisk) {
    const TemporaryFolder folder;
    write_png(folder / "file", Image<EncodedRgb>(4, 4));
    const auto code = [](const std::function<void()>& write) {
        try {
            write();
        } catch (const Error& e) {
            return std::optional(e.code());
        }
        return std::optional<ExitCode>();
    };
    const Image<EncodedRgb> picture(4, 4);
    EXPECT_EQ(code([&] { write_png(folder / "file/a.png", picture); }), ExitCode::cannot_create);
    EXPECT_EQ(code([&] { write_png("/proc/a.png", picture); }), ExitCode::cannot_create);
    EXPECT_EQ(code([&] { make_folder(folder / "file/sub"); }), ExitCode::cannot_create);
    EXPECT_EQ(code([&] { make_folder(folder / "file"); }), ExitCode::cannot_create);
    EXPECT_EQ(code([&] { make_folder(folder / "a/b/c"); }), std::nullopt);
    EXPECT_EQ(code([&] { write_png(folder / "a", picture); }),
              ExitCode::cannot_create);  // a folder
    EXPECT_EQ(folder.entries(), 2);
}

}  // namespace
}  // namespace inlay
