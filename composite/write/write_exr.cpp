#include "composite/write/write_exr.h"

#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <Imath/ImathMatrix.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticities.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfVecAttribute.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <limits>
#include <set>
#include <utility>

namespace inlay {
namespace {

/// OpenEXR's view of a growing buffer.
class MemoryStream : public Imf::OStream {
public:
    MemoryStream() : Imf::OStream("memory") {}
    void write(const char data[], int count) override {
        const std::size_t end = position_ + std::size_t(count);
        if (end > bytes.size()) bytes.resize(end);
        std::memcpy(bytes.data() + position_, data, std::size_t(count));
        position_ = end;
    }
    std::uint64_t tellp() override { return position_; }
    void seekp(std::uint64_t position) override { position_ = std::size_t(position); }

    std::vector<std::byte> bytes;

private:
    std::size_t position_ = 0;
};

/// One channel, as planar samples of the type it has in the file.
struct Channel {
    std::string name;
    std::vector<half> halves;  // one of the two is filled
    std::vector<float> floats;
};

struct Size {
    int width = 0, height = 0;
    bool operator==(const Size&) const = default;
};

constexpr float largest_half = 65504.0f;

std::string with_suffix(const std::string& layer, const char* channel) {
    return layer.empty() ? channel : layer + "." + channel;
}

[[noreturn]] void refuse_value(const std::string& channel, std::size_t i, int width, float value) {
    throw Error(ExitCode::bad_data,
                "channel " + channel + " holds " + std::to_string(value) + " at pixel (" +
                    std::to_string(i % std::size_t(width)) + ", " +
                    std::to_string(i / std::size_t(width)) +
                    "): only finite values are written; this is a fault of the simulation");
}

/// Gathers `value_of(i)` over the pixels into a channel.
template <class ValueOf>
Channel gather(const std::string& name, Size size, ExrPrecision precision, ValueOf value_of) {
    Channel channel{name, {}, {}};
    const std::size_t count = std::size_t(size.width) * std::size_t(size.height);
    const bool as_half = precision == ExrPrecision::half_float;
    as_half ? channel.halves.reserve(count) : channel.floats.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float value = value_of(i);
        if (!std::isfinite(value)) refuse_value(name, i, size.width, value);
        if (as_half)
            channel.halves.emplace_back(std::clamp(value, -largest_half, largest_half));
        else
            channel.floats.push_back(value);
    }
    return channel;
}

void add_triple(std::deque<Channel>& channels, const std::string& layer,
                const std::array<const char*, 3>& names, const Image<glm::vec3>& image,
                ExrPrecision precision) {
    for (int c = 0; c < 3; ++c)
        channels.push_back(gather(with_suffix(layer, names[std::size_t(c)]),
                                  {image.width, image.height}, precision,
                                  [&](std::size_t i) { return image.pixels[i][c]; }));
}

void add_layer(std::deque<Channel>& channels, const ExrLayer& layer) {
    if (const auto* value = std::get_if<const Image<float>*>(&layer.image)) {
        const Image<float>& image = **value;
        channels.push_back(gather(layer.name, {image.width, image.height}, ExrPrecision::full_float,
                                  [&](std::size_t i) { return image.pixels[i]; }));
        return;
    }
    const auto& image = *std::get<const Image<glm::vec3>*>(layer.image);
    if (layer.kind == ExrLayerKind::vector)
        add_triple(channels, layer.name, {"X", "Y", "Z"}, image, ExrPrecision::full_float);
    else
        add_triple(channels, layer.name, {"R", "G", "B"}, image, ExrPrecision::half_float);
}

Size size_of(const ExrLayer& layer) {
    return std::visit(
        [](const auto* image) {
            return Size{image->width, image->height};
        },
        layer.image);
}

Size size_of(const ExrFile& contents) {
    require(contents.picture != nullptr || !contents.layers.empty(),
            "an EXR file needs a picture or a layer");
    const Size size = contents.picture != nullptr
                          ? Size{contents.picture->width, contents.picture->height}
                          : size_of(contents.layers.front());
    require(size.width > 0 && size.height > 0, "an EXR file needs at least one pixel");
    return size;
}

/// Nuke splits names at '.', drops leading digits and turns other characters into '_', so names
/// that differ by punctuation alone would fall together.
void check_layers(const ExrFile& contents, Size size) {
    std::set<std::string> seen{"R", "G", "B", "A"};
    for (const ExrLayer& layer : contents.layers) {
        const std::string& name = layer.name;
        const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
            return std::isalnum(c) != 0 || c == '_';
        });
        require(plain && !name.empty() && std::isalpha(static_cast<unsigned char>(name[0])) != 0,
                "EXR layer \"" + name + "\": expected letters, digits and '_', a letter first");
        std::string bare = name;
        std::erase(bare, '_');
        require(seen.insert(bare).second,
                "EXR layer \"" + name + "\": another one differs from it by '_' alone");
        require(size_of(layer) == size,
                "EXR layer \"" + name + "\": is " + std::to_string(size_of(layer).width) + " x " +
                    std::to_string(size_of(layer).height) + " px, expected " +
                    std::to_string(size.width) + " x " + std::to_string(size.height));
    }
}

/// Row-major as OpenEXR prints it: m[row][column], to be applied to column vectors.
Imath::M44f row_major(const Pose& target_from_source) {
    Imath::M44f m;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            m[row][column] = float(target_from_source.rotation[column][row]);
        m[row][3] = float(target_from_source.translation[row]);
    }
    return m;
}

Imf::Header header_of(const ExrFile& contents, Size size) {
    Imf::Header header(size.width, size.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    header.lineOrder() = Imf::INCREASING_Y;
    Imf::addChromaticities(header, Imf::Chromaticities());  // defaults: Rec. 709, D65
    if (contents.frame) header.insert("inlay/frame", Imf::IntAttribute(*contents.frame));
    const Rgb& exposure = contents.exposure;
    if (exposure != Rgb(1))
        header.insert("inlay/exposure",
                      Imf::V3fAttribute(Imath::V3f(exposure.r, exposure.g, exposure.b)));
    if (contents.world_from_camera)
        header.insert("inlay/worldFromCamera",
                      Imf::M44fAttribute(row_major(*contents.world_from_camera)));
    return header;
}

template <class Sample>
Imf::Slice slice_of(Imf::PixelType type, std::vector<Sample>& samples, int width) {
    return Imf::Slice(type, reinterpret_cast<char*>(samples.data()), sizeof(Sample),
                      sizeof(Sample) * std::size_t(width));
}

std::vector<std::byte> encode(Imf::Header header, std::deque<Channel>& channels, Size size) {
    Imf::FrameBuffer buffer;
    for (Channel& channel : channels) {
        const bool as_half = !channel.halves.empty();
        header.channels().insert(channel.name, Imf::Channel(as_half ? Imf::HALF : Imf::FLOAT));
        buffer.insert(channel.name, as_half ? slice_of(Imf::HALF, channel.halves, size.width)
                                            : slice_of(Imf::FLOAT, channel.floats, size.width));
    }
    MemoryStream stream;
    {
        Imf::OutputFile file(stream, header);
        file.setFrameBuffer(buffer);
        file.writePixels(size.height);
    }
    return std::move(stream.bytes);
}

}  // namespace

ExrLayer color_layer(std::string name, const Image<Rgb>& image) {
    return {std::move(name), ExrLayerKind::color, &image};
}

ExrLayer vector_layer(std::string name, const Image<glm::vec3>& image) {
    return {std::move(name), ExrLayerKind::vector, &image};
}

ExrLayer value_layer(std::string name, const Image<float>& image) {
    return {std::move(name), ExrLayerKind::value, &image};
}

std::vector<std::byte> encode_exr(const ExrFile& contents) {
    const Size size = size_of(contents);
    check_layers(contents, size);
    std::deque<Channel> channels;
    if (contents.picture != nullptr)
        add_triple(channels, "", {"R", "G", "B"}, *contents.picture, contents.picture_precision);
    for (const ExrLayer& layer : contents.layers)
        add_layer(channels, layer);
    return encode(header_of(contents, size), channels, size);
}

void write_exr(const std::filesystem::path& file, const ExrFile& contents) {
    write_file(file, encode_exr(contents));
}

}  // namespace inlay
