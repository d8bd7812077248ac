#include "render/scene/texture_files.h"

#include "recordings/base/check.h"

#include <opencv2/imgcodecs.hpp>

#include <cstdint>
#include <fstream>
#include <sstream>

namespace inlay {

namespace fs = std::filesystem;

namespace {

constexpr unsigned max_side = 16384;  // px
constexpr std::uintmax_t max_bytes = 512u << 20;

struct Size {
    unsigned width = 0, height = 0;  // px
};

unsigned big_endian(std::span<const std::byte> bytes, std::size_t at, int count) {
    unsigned value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | std::to_integer<unsigned>(bytes[at + std::size_t(i)]);
    return value;
}

/// The size a PNG or JPEG claims, before a decoder takes memory for it; 0 x 0 where it is neither.
Size claimed_size(std::span<const std::byte> bytes) {
    if (bytes.size() >= 24 && big_endian(bytes, 0, 4) == 0x89504e47u)
        return {big_endian(bytes, 16, 4), big_endian(bytes, 20, 4)};
    if (bytes.size() < 4 || big_endian(bytes, 0, 2) != 0xffd8u) return {};
    for (std::size_t at = 2; at + 9 < bytes.size();) {
        const unsigned marker = big_endian(bytes, at, 2);
        if (marker == 0xffffu) {
            ++at;  // fill byte
            continue;
        }
        if (marker < 0xffc0u) return {};
        const bool frame =
            marker <= 0xffcfu && marker != 0xffc4u && marker != 0xffc8u && marker != 0xffccu;
        if (frame) return {big_endian(bytes, at + 7, 2), big_endian(bytes, at + 5, 2)};
        at += 2 + big_endian(bytes, at + 2, 2);
    }
    return {};
}

/// A decoder fills what is missing of a JPEG with grey; only the end marker tells.
bool cut_off(std::span<const std::byte> bytes) {
    if (big_endian(bytes, 0, 2) != 0xffd8u) return false;
    for (std::size_t at = bytes.size() - 1; at-- > 2;)
        if (big_endian(bytes, at, 2) == 0xffd9u) return false;
    return true;
}

cv::Mat decode_pixels(std::span<const std::byte> bytes, const std::string& place) {
    const Size size = claimed_size(bytes);
    require(
        size.width >= 1 && size.height >= 1 && size.width <= max_side && size.height <= max_side,
        place + ": " + std::to_string(size.width) + " x " + std::to_string(size.height) +
            " px; expected a PNG or JPEG of 1 to " + std::to_string(max_side) + " px a side");
    cv::Mat pixels;
    try {
        const cv::Mat buffer(1, int(bytes.size()), CV_8U,
                             const_cast<std::byte*>(bytes.data()));  // only read
        pixels = cv::imdecode(buffer, cv::IMREAD_UNCHANGED);
    } catch (const cv::Exception& fault) {
        throw Error(ExitCode::bad_data, place + ": " + fault.what());
    }
    require(!pixels.empty() && !cut_off(bytes),
            place + ": damaged or cut off; save the texture again");
    require(pixels.depth() == CV_8U,
            place + ": not 8 bits a channel; save it as 8-bit PNG or JPEG");
    return pixels;
}

EncodedRgb pixel(const cv::Mat& pixels, int x, int y) {
    const std::uint8_t* p = pixels.ptr(y, x);
    if (pixels.channels() < 3) return {p[0], p[0], p[0]};
    return {p[2], p[1], p[0]};
}

}  // namespace

std::shared_ptr<const Texture> decode_texture(std::span<const std::byte> bytes,
                                              const std::string& place, bool linear) {
    const cv::Mat pixels = decode_pixels(bytes, place);
    Texture texture(pixels.cols, pixels.rows);
    for (int y = 0; y < texture.height; ++y) {
        for (int x = 0; x < texture.width; ++x) {
            const EncodedRgb p = pixel(pixels, x, y);
            texture(x, y) = linear ? Rgb(p.r, p.g, p.b) / 255.0f : decode(p);
        }
    }
    return std::make_shared<const Texture>(std::move(texture));
}

std::shared_ptr<const Texture> load_texture(const fs::path& file, bool linear) {
    std::error_code ignored;
    require(fs::is_regular_file(file, ignored), file.string() + ": no such file",
            ExitCode::input_missing);
    require(fs::file_size(file, ignored) <= max_bytes, file.string() + ": larger than 512 MiB");
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream bytes;
    bytes << stream.rdbuf();
    require(bool(stream), file.string() + ": cannot be read; check its permissions",
            ExitCode::input_missing);
    const std::string text = bytes.str();
    return decode_texture(std::as_bytes(std::span(text)), file.string(), linear);
}

}  // namespace inlay
