// Videos: made by a child process, whose absence and death are errors and nothing worse.
#include "composite/write/write_video.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace inlay {
namespace {

using test::file_text;
using test::TemporaryFolder;

Image<EncodedRgb> flat(int width, int height, EncodedRgb color) {
    return Image<EncodedRgb>(width, height, color);
}

Image<EncodedRgb> moving_bar(int width, int height, int frame) {
    Image<EncodedRgb> image(width, height, {40, 80, 120});
    for (int y = 0; y < height; ++y)
        image((3 * frame) % width, y) = {250, 200, 20};
    return image;
}

/// A property of the video's picture stream, as ffprobe prints it.
std::string probe(const std::filesystem::path& file, const std::string& entry) {
    const std::string command =
        "ffprobe -v error -count_frames -select_streams v:0 -of "
        "default=nokey=1:noprint_wrappers=1 -show_entries stream=" +
        entry + " " + file.string();
    std::FILE* pipe = ::popen(command.c_str(), "r");
    std::string text;
    for (int c = std::fgetc(pipe); c != EOF && c != '\n'; c = std::fgetc(pipe))
        text.push_back(char(c));
    ::pclose(pipe);
    return text;
}

/// The first frame, decoded to rgb24.
std::string first_frame(const std::filesystem::path& file, const TemporaryFolder& folder) {
    const std::string raw = (folder / "frame.rgb").string();
    const std::string command =
        "ffmpeg -v error -y -i " + file.string() + " -frames:v 1 -f rawvideo -pix_fmt rgb24 " + raw;
    EXPECT_EQ(std::system(command.c_str()), 0);
    return file_text(raw);
}

void write_bars(const std::filesystem::path& file, int width, int height, int frames) {
    VideoWriter video(file, width, height, {.frames_per_second = 25});
    for (int i = 0; i < frames; ++i)
        video.write(moving_bar(width, height, i));
    video.close();
}

TEST(WriteVideo, HoldsEveryFrameInItsSizeAndRate) {
    const TemporaryFolder folder;
    write_bars(folder / "a.mp4", 64, 48, 12);
    EXPECT_EQ(probe(folder / "a.mp4", "codec_name"), "h264");
    EXPECT_EQ(probe(folder / "a.mp4", "width"), "64");
    EXPECT_EQ(probe(folder / "a.mp4", "height"), "48");
    EXPECT_EQ(probe(folder / "a.mp4", "nb_read_frames"), "12");
    EXPECT_EQ(probe(folder / "a.mp4", "r_frame_rate"), "25/1");
    EXPECT_EQ(probe(folder / "a.mp4", "pix_fmt"), "yuv420p");
    EXPECT_EQ(folder.entries(), 1);
}

TEST(WriteVideo, PadsOddSizes) {
    const TemporaryFolder folder;
    write_bars(folder / "a.mp4", 33, 17, 3);
    EXPECT_EQ(probe(folder / "a.mp4", "width"), "34");
    EXPECT_EQ(probe(folder / "a.mp4", "height"), "18");
}

TEST(WriteVideo, KeepsColors) {
    for (const EncodedRgb color : {EncodedRgb{200, 60, 30}, EncodedRgb{20, 180, 90},
                                   EncodedRgb{40, 50, 220}, EncodedRgb{255, 255, 255}}) {
        const TemporaryFolder folder;
        VideoWriter video(folder / "a.mp4", 32, 32);
        video.write(flat(32, 32, color));
        video.close();
        const std::string pixels = first_frame(folder / "a.mp4", folder);
        ASSERT_EQ(pixels.size(), 32u * 32u * 3u);
        // 3: 8-bit limited-range YCbCr rounds to about 1.2 steps a channel, and x264 at crf 18 adds
        // about one; Rec. 601 in place of Rec. 709 would be off by 10 and more
        EXPECT_NEAR(std::uint8_t(pixels[0]), color.r, 3);
        EXPECT_NEAR(std::uint8_t(pixels[1]), color.g, 3);
        EXPECT_NEAR(std::uint8_t(pixels[2]), color.b, 3);
    }
}

TEST(WriteVideo, EqualFramesGiveEqualBytes) {
    const TemporaryFolder folder;
    write_bars(folder / "a.mp4", 160, 120, 20);
    write_bars(folder / "b.mp4", 160, 120, 20);
    EXPECT_GT(file_text(folder / "a.mp4").size(), 1000u);
    EXPECT_EQ(file_text(folder / "a.mp4"), file_text(folder / "b.mp4"));
}

TEST(WriteVideo, LeavesNothingWhenItIsNotClosed) {
    const TemporaryFolder folder;
    {
        VideoWriter video(folder / "a.mp4", 64, 48);
        video.write(moving_bar(64, 48, 0));
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteVideo, SaysThatTheEncoderIsMissing) {
    const TemporaryFolder folder;
    try {
        VideoWriter video(folder / "a.mp4", 64, 48, {.encoder = "no-such-encoder"});
        FAIL() << "an encoder was started that does not exist";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::cannot_create);
        EXPECT_NE(std::string(e.what()).find("install ffmpeg"), std::string::npos) << e.what();
    }
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteVideo, SurvivesTheDeathOfItsEncoder) {
    // `false` reads nothing and ends at once: a write to a pipe would kill us with SIGPIPE
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.mp4", 640, 480, {.encoder = "false"});
    EXPECT_THROW(
        {
            for (int i = 0; i < 100; ++i)
                video.write(moving_bar(640, 480, i));
        },
        Error);
    EXPECT_THROW(video.write(moving_bar(640, 480, 0)), Error);
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteVideo, ReportsAnEncoderThatFailsAtTheEnd) {
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.mp4", 2, 2, {.encoder = "false"});
    EXPECT_THROW(video.close(), Error);
    EXPECT_EQ(folder.entries(), 0);
}

TEST(WriteVideo, RefusesFramesOfAnotherSize) {
    const TemporaryFolder folder;
    VideoWriter video(folder / "a.mp4", 64, 48);
    EXPECT_THROW(video.write(flat(64, 47, {})), Error);
}

TEST(WriteVideo, WritesToNamesThatLookLikeOptionsOrProtocols) {
    const TemporaryFolder folder;
    for (const char* name : {"-y.mp4", "http:x.mp4", "50%d.mp4"}) {
        write_bars(folder / name, 16, 16, 2);
        EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
    }
    EXPECT_EQ(folder.entries(), 3);
}

}  // namespace
}  // namespace inlay
