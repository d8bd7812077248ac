#include "recordings/readers/image_files.h"

#include "recordings/base/check.h"
#include "recordings/readers/text_file.h"

#include <opencv2/imgcodecs.hpp>

#include <cctype>
#include <cstdint>
#include <optional>
#include <string_view>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr std::uintmax_t file_limit = 512u << 20;  // bytes
constexpr int side_limit = 16384;                  // px

unsigned byte_at(std::string_view b, std::size_t i) { return static_cast<unsigned char>(b[i]); }

unsigned big_endian(std::string_view b, std::size_t at, int count) {
    unsigned value = 0;
    for (int i = 0; i < count; ++i)
        value = value << 8 | byte_at(b, at + std::size_t(i));
    return value;
}

int clamped_size(unsigned value) { return int(std::min(value, unsigned(side_limit) + 1)); }

std::optional<ImageHeader> png_header(std::string_view b) {
    if (!b.starts_with("\x89PNG\r\n\x1a\n")) return std::nullopt;
    ImageHeader header{.format = "PNG"};
    if (b.size() < 26 || b.substr(12, 4) != "IHDR") return header;
    const unsigned kind = byte_at(b, 25);
    header.width = clamped_size(big_endian(b, 16, 4));
    header.height = clamped_size(big_endian(b, 20, 4));
    header.bits = int(byte_at(b, 24));
    header.palette = kind == 3;
    header.channels = kind == 0 ? 1 : kind == 4 ? 2 : kind == 6 ? 4 : 3;
    return header;
}

/// Walks the segments of a JPEG; `scan` is where the compressed pixels begin, 0 if nowhere.
struct JpegLayout {
    ImageHeader header{.format = "JPEG"};
    std::size_t scan = 0;
};

std::optional<JpegLayout> jpeg_layout(std::string_view b) {
    if (!b.starts_with("\xff\xd8\xff")) return std::nullopt;
    JpegLayout layout;
    std::size_t at = 2;
    while (at + 4 <= b.size() && byte_at(b, at) == 0xff) {
        const unsigned marker = byte_at(b, at + 1);
        const std::size_t length = big_endian(b, at + 2, 2);
        const bool frame =
            marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (marker == 0xff) {  // fill byte
            ++at;
            continue;
        }
        if (frame && at + 10 <= b.size()) {
            layout.header.bits = int(byte_at(b, at + 4));
            layout.header.height = clamped_size(big_endian(b, at + 5, 2));
            layout.header.width = clamped_size(big_endian(b, at + 7, 2));
            layout.header.channels = int(byte_at(b, at + 9));
        }
        at += 2 + length;
        if (marker != 0xda) continue;
        layout.scan = at;
        break;
    }
    return layout;
}

/// The next number of a PNM header, which may hold comments.
int pnm_number(std::string_view b, std::size_t& at) {
    while (at < b.size() && (std::isspace(int(byte_at(b, at))) || b[at] == '#')) {
        if (b[at] == '#') at = std::min(b.find('\n', at), b.size() - 1);
        ++at;
    }
    int value = 0;
    while (at < b.size() && std::isdigit(int(byte_at(b, at))))
        value = std::min(value * 10 + (b[at++] - '0'), 1 << 20);
    return value;
}

std::optional<ImageHeader> pnm_header(std::string_view b) {
    if (!b.starts_with("P5") && !b.starts_with("P6")) return std::nullopt;
    ImageHeader header{.format = "PNM", .channels = b[1] == '5' ? 1 : 3};
    std::size_t at = 2;
    header.width = std::min(pnm_number(b, at), side_limit + 1);
    header.height = std::min(pnm_number(b, at), side_limit + 1);
    header.bits = pnm_number(b, at) > 255 ? 16 : 8;
    return header;
}

ImageHeader parse_header(const fs::path& file, std::string_view bytes) {
    std::optional<ImageHeader> header = png_header(bytes);
    if (!header) header = pnm_header(bytes);
    if (!header)
        if (const auto layout = jpeg_layout(bytes)) header = layout->header;
    require(header.has_value(), file.string() + ": found '" + printable(bytes.substr(0, 8)) +
                                    "' at its start, expected a PNG, JPEG or PNM image");
    require(header->width > 0 && header->height > 0,
            file.string() + ": the " + header->format + " header is cut off or damaged");
    require(
        header->width <= side_limit && header->height <= side_limit,
        file.string() + ": the image has more than " + std::to_string(side_limit) + " px a side");
    return *header;
}

std::string describe(const ImageHeader& h) {
    return std::to_string(h.bits) + "-bit " + (h.palette ? "palette " : "") + h.format + " with " +
           std::to_string(h.channels) + (h.channels == 1 ? " channel" : " channels");
}

/// A JPEG that ends early decodes to grey without an error, so its end is looked for.
bool complete(std::string_view bytes) {
    const auto layout = jpeg_layout(bytes);
    if (!layout) return true;
    return layout->scan > 0 && bytes.find("\xff\xd9", layout->scan) != std::string_view::npos;
}

cv::Mat decode_file(const fs::path& file, std::string& bytes, int flags, int type) {
    const std::string damaged = file.string() + ": the image is damaged or cut off";
    require(complete(bytes), damaged);
    cv::Mat decoded;
    try {
        const cv::Mat encoded(1, int(bytes.size()), CV_8UC1, bytes.data());
        decoded = cv::imdecode(encoded, flags);
    } catch (const cv::Exception&) {
        throw Error(ExitCode::bad_data, damaged);
    }
    require(!decoded.empty() && decoded.type() == type, damaged);
    return decoded;
}

}  // namespace

ImageHeader read_image_header(const fs::path& file) {
    return parse_header(file, read_bytes(file, file_limit));
}

void require_depth_format(const fs::path& file, const ImageHeader& header) {
    const bool fits =
        header.bits == 16 && header.channels == 1 && !header.palette && header.format != "JPEG";
    require(fits, file.string() + ": found a " + describe(header) +
                      ", expected depth as a 16-bit PNG or PGM with 1 channel");
}

Image<EncodedRgb> read_color(const fs::path& file) {
    std::string bytes = read_bytes(file, file_limit);
    const ImageHeader header = parse_header(file, bytes);
    require(header.bits <= 8, file.string() + ": found a " + describe(header) +
                                  ", expected color with 8 bits a channel");
    const cv::Mat decoded =
        decode_file(file, bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION, CV_8UC3);
    Image<EncodedRgb> color(decoded.cols, decoded.rows);
    for (int y = 0; y < color.height; ++y) {
        const auto* bgr = decoded.ptr<cv::Vec3b>(y);
        for (int x = 0; x < color.width; ++x)
            color(x, y) = {bgr[x][2], bgr[x][1], bgr[x][0]};
    }
    return color;
}

Image<float> read_depth(const fs::path& file, double units_per_metre, float max_depth) {
    std::string bytes = read_bytes(file, file_limit);
    require_depth_format(file, parse_header(file, bytes));
    const cv::Mat decoded = decode_file(file, bytes, cv::IMREAD_UNCHANGED, CV_16UC1);
    Image<float> depth(decoded.cols, decoded.rows);
    for (int y = 0; y < depth.height; ++y) {
        const auto* stored = decoded.ptr<std::uint16_t>(y);
        for (int x = 0; x < depth.width; ++x) {
            const std::uint16_t raw = stored[x] == 65535 ? std::uint16_t(0) : stored[x];
            const auto metres = float(raw / units_per_metre);
            depth(x, y) = max_depth > 0 && metres > max_depth ? 0.0f : metres;
        }
    }
    return depth;
}

}  // namespace inlay
