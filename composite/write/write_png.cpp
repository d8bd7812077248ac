#include "composite/write/write_png.h"

#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>

namespace inlay {
namespace {

/// Level and strategy are fixed, so that the bytes are; 3 is twice as fast as the usual 6 and
/// hardly larger on photographs.
const std::vector<int>& png_parameters() {
    static const std::vector<int> parameters{
        cv::IMWRITE_PNG_COMPRESSION, 3, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_DEFAULT};
    return parameters;
}

std::vector<std::byte> encode(const cv::Mat& picture) {
    std::vector<unsigned char> bytes;
    require(!picture.empty() && cv::imencode(".png", picture, bytes, png_parameters()),
            "a picture of " + std::to_string(picture.cols) + " x " + std::to_string(picture.rows) +
                " px cannot be encoded as PNG");
    std::vector<std::byte> result(bytes.size());
    std::transform(bytes.begin(), bytes.end(), result.begin(),
                   [](unsigned char b) { return std::byte(b); });
    return result;
}

}  // namespace

std::vector<std::byte> encode_png(const Image<EncodedRgb>& image) {
    cv::Mat picture(image.height, image.width, CV_8UC3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const EncodedRgb& c = image(x, y);
            picture.at<cv::Vec3b>(y, x) = {c.b, c.g, c.r};
        }
    return encode(picture);
}

std::vector<std::byte> encode_png(const Image<std::uint16_t>& image) {
    cv::Mat picture(image.height, image.width, CV_16UC1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            picture.at<std::uint16_t>(y, x) = image(x, y);
    return encode(picture);
}

void write_png(const std::filesystem::path& file, const Image<EncodedRgb>& image) {
    write_file(file, encode_png(image));
}

void write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image) {
    write_file(file, encode_png(image));
}

}  // namespace inlay
