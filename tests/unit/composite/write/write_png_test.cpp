// PNG files read back to the same pixels, and their bytes depend on nothing else.
#include "composite/write/write_png.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace inlay {
namespace {

using test::TemporaryFolder;

Image<EncodedRgb> noise(int width, int height) {
    Image<EncodedRgb> image(width, height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint32_t bits = hash(std::uint32_t(i));
        image.pixels[i] = {std::uint8_t(bits), std::uint8_t(bits >> 8), std::uint8_t(bits >> 16)};
    }
    return image;
}

TEST(WritePng, ColorReadsBack) {
    const TemporaryFolder folder;
    const Image<EncodedRgb> image = noise(37, 21);
    write_png(folder / "color.png", image);
    const cv::Mat read = cv::imread((folder / "color.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), CV_8UC3);
    ASSERT_EQ(read.size(), cv::Size(37, 21));
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const cv::Vec3b bgr = read.at<cv::Vec3b>(y, x);
            ASSERT_EQ(image(x, y), (EncodedRgb{bgr[2], bgr[1], bgr[0]})) << x << ", " << y;
        }
}

TEST(WritePng, DepthKeepsSixteenBits) {
    const TemporaryFolder folder;
    Image<std::uint16_t> depth(300, 219);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i)
        depth.pixels[i] = std::uint16_t(i);
    write_png(folder / "depth.png", depth);
    const cv::Mat read = cv::imread((folder / "depth.png").string(), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), CV_16UC1);
    ASSERT_TRUE(read.isContinuous());
    const auto* first = read.ptr<std::uint16_t>();
    EXPECT_TRUE(std::equal(depth.pixels.begin(), depth.pixels.end(), first));
}

TEST(WritePng, EqualPixelsGiveEqualBytes) {
    EXPECT_EQ(encode_png(noise(64, 48)), encode_png(noise(64, 48)));
}

TEST(WritePng, LeavesOneFileAndReplacesTheOldOne) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", noise(8, 8));
    write_png(folder / "a.png", noise(9, 9));
    EXPECT_EQ(folder.entries(), 1);
    EXPECT_EQ(cv::imread((folder / "a.png").string()).cols, 9);
}

TEST(WritePng, NamesTheFileWhenTheFolderIsMissing) {
    const TemporaryFolder folder;
    try {
        write_png(folder / "missing/a.png", noise(2, 2));
        FAIL() << "a file appeared in a folder that does not exist";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::cannot_create);
        EXPECT_NE(std::string(e.what()).find("missing/a.png"), std::string::npos) << e.what();
    }
}

TEST(WritePng, RefusesAnEmptyImage) { EXPECT_THROW(encode_png(Image<EncodedRgb>()), Error); }

}  // namespace
}  // namespace inlay
