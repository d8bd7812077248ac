// Golden images: means and variances on disk, and the test that a new picture agrees with them.
#pragma once

#include "recordings/base/color.h"
#include "tests/support/mean_test.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

namespace inlay::test {

/// Mean and variance, per pixel and channel, of one sample.
struct GoldenImage {
    Image<Rgb> mean, variance;
};

/// Renders `samples` samples per pixel with random numbers of `seed`.
using GoldenRenderer = std::function<GoldenImage(int samples, std::uint32_t seed)>;

/// Name of the reference to make anew instead of testing against it; set by --update.
inline std::string& golden_to_update() {
    static std::string name;
    return name;
}

inline Imf::FrameBuffer golden_frame(Image<Rgb>& image) {
    Imf::FrameBuffer frame;
    char* first = reinterpret_cast<char*>(image.pixels.data());
    const std::size_t row = sizeof(Rgb) * std::size_t(image.width);
    const char* names[] = {"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c)
        frame.insert(names[c], {Imf::FLOAT, first + c * sizeof(float), sizeof(Rgb), row});
    return frame;
}

inline void write_golden(const std::filesystem::path& file, Image<Rgb> image) {
    std::filesystem::create_directories(file.parent_path());
    Imf::Header header(image.width, image.height);
    for (const char* name : {"R", "G", "B"})
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    Imf::OutputFile output(file.c_str(), header);
    output.setFrameBuffer(golden_frame(image));
    output.writePixels(image.height);
}

inline Image<Rgb> read_golden(const std::filesystem::path& file) {
    Imf::InputFile input(file.c_str());
    const auto window = input.header().dataWindow();
    Image<Rgb> image(window.max.x + 1, window.max.y + 1);
    input.setFrameBuffer(golden_frame(image));
    input.readPixels(0, window.max.y);
    return image;
}

/// p-values of a picture against its reference.
struct GoldenResult {
    double smallest_pixel_p = 1, whole_image_p = 1;
    Image<Rgb> deviation;  // in standard errors
};

inline GoldenResult compare_golden(const GoldenImage& picture, int samples,
                                   const GoldenImage& reference, int reference_samples) {
    GoldenResult result;
    result.deviation = Image<Rgb>(picture.mean.width, picture.mean.height);
    double difference = 0, variance = 0;
    for (std::size_t i = 0; i < picture.mean.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const double off = double(picture.mean.pixels[i][c]) - reference.mean.pixels[i][c];
            const double v =
                reference.variance.pixels[i][c] * (1.0 / samples + 1.0 / reference_samples);
            // Radiance that does not vary still differs by float rounding.
            const double z = off / std::sqrt(v + 1e-10);
            result.deviation.pixels[i][c] = float(z);
            result.smallest_pixel_p = std::min(result.smallest_pixel_p, normal_p_value(z));
            difference += off;
            variance += v;
        }
    }
    result.whole_image_p = normal_p_value(difference / std::sqrt(variance + 1e-10));
    return result;
}

/// Tests a renderer against tests/golden/references/`name`.{mean,variance}.exr, or makes these
/// anew. The significance of 0.01 is shared by all pixels, channels and the image as a whole.
inline void expect_golden(const std::string& name, const GoldenRenderer& render, int samples) {
    constexpr int reference_samples = 16384;
    const std::filesystem::path folder =
        std::filesystem::path(INLAY_SOURCE_DIR) / "tests/golden/references";
    const auto file = [&](const char* kind) { return folder / (name + "." + kind + ".exr"); };
    if (golden_to_update() == name) {
        const GoldenImage made = render(reference_samples, 1);
        write_golden(file("mean"), made.mean);
        write_golden(file("variance"), made.variance);
        return;
    }
    const GoldenImage reference{read_golden(file("mean")), read_golden(file("variance"))};
    const GoldenImage picture = render(samples, 2);
    ASSERT_TRUE(same_size(picture.mean, reference.mean));
    const GoldenResult result = compare_golden(picture, samples, reference, reference_samples);
    const double limit = sidak(0.01, int(3 * picture.mean.pixels.size()) + 1);
    EXPECT_GE(result.whole_image_p, limit) << "the picture as a whole";
    EXPECT_GE(result.smallest_pixel_p, limit) << "some pixel";
    if (!::testing::Test::HasFailure()) return;
    const std::filesystem::path failures = "golden_failures";
    write_golden(failures / (name + ".exr"), picture.mean);
    write_golden(failures / (name + ".reference.exr"), reference.mean);
    write_golden(failures / (name + ".deviation.exr"), result.deviation);
    ADD_FAILURE() << "picture, reference and deviation (in standard errors) are in "
                  << std::filesystem::absolute(failures).string();
}

}  // namespace inlay::test
