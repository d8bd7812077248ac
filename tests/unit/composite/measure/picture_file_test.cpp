// Pictures of every kind, read for comparison.
#include "composite/measure/picture_file.h"

#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "recordings/base/check.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <cmath>
#include <fstream>
#include <limits>

namespace inlay {
namespace {

using test::TemporaryFolder;

Image<EncodedRgb> ramp() {
    Image<EncodedRgb> image(16, 16);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {std::uint8_t(i), std::uint8_t(255 - i), 77};
    return image;
}

TEST(PictureFile, PngIsDisplayAndLinearFollows) {
    const TemporaryFolder folder;
    write_png(folder / "a.png", ramp());
    const ComparedPicture picture = read_picture(folder / "a.png");
    EXPECT_EQ(picture.display.pixels, ramp().pixels);
    EXPECT_EQ(picture.linear.pixels, decode(ramp()).pixels);
}

TEST(PictureFile, ExrIsLinearAndDisplayFollows) {
    const TemporaryFolder folder;
    const Image<Rgb> linear = decode(ramp());
    write_exr(folder / "a.exr",
              {.picture = &linear, .picture_precision = ExrPrecision::full_float});
    const ComparedPicture picture = read_picture(folder / "a.exr");
    EXPECT_EQ(picture.linear.pixels, linear.pixels);
    EXPECT_EQ(picture.display.pixels, ramp().pixels);
    write_png(folder / "a.png", ramp());
    EXPECT_EQ(picture_error(picture, read_picture(folder / "a.png")).radiance.rmse, 0);
}

TEST(PictureFile, HdrKeepsRedFirstAndMoreThanOne) {
    const TemporaryFolder folder;
    const cv::Mat bgr(9, 12, CV_32FC3, cv::Scalar(0.25, 1, 8));
    ASSERT_TRUE(cv::imwrite((folder / "a.hdr").string(), bgr));
    const ComparedPicture picture = read_picture(folder / "a.hdr");
    EXPECT_EQ(picture.linear.width, 12);
    // 8 bits of mantissa shared with the largest channel
    EXPECT_NEAR(picture.linear(3, 3).r, 8.0f, 8.0f / 128);
    EXPECT_NEAR(picture.linear(3, 3).b, 0.25f, 8.0f / 128);
    EXPECT_EQ(picture.display(3, 3).r, 255);
}

TEST(PictureError, LeavesOutPixelsThatAreNotFinite) {
    ComparedPicture a{Image<Rgb>(20, 20, Rgb(0.5f)), encode(Image<Rgb>(20, 20, Rgb(0.5f)))};
    const ComparedPicture b = a;
    a.linear(3, 4).g = std::numeric_limits<float>::quiet_NaN();
    a.display(3, 4) = {0, 0, 0};
    const PictureError error = picture_error(a, b);
    EXPECT_EQ(error.radiance.non_finite, 1u);
    EXPECT_EQ(error.radiance.rmse, 0);
    EXPECT_EQ(error.display.psnr, std::numeric_limits<double>::infinity());
}

TEST(PictureFile, TellsMissingFromBad) {
    const TemporaryFolder folder;
    const auto code = [](const std::filesystem::path& file) {
        try {
            read_picture(file);
        } catch (const Error& e) {
            return e.code();
        }
        return ExitCode::done;
    };
    EXPECT_EQ(code(folder / "none.png"), ExitCode::input_missing);
    for (const char* name : {"a.txt", "a.png", "a.exr", "a.hdr", "a.jpg"}) {
        std::ofstream(folder / name) << "this is no picture";
        EXPECT_EQ(code(folder / name), ExitCode::bad_data) << name;
    }
}

}  // namespace
}  // namespace inlay
