#include "recordings/environment/exr_image.h"

#include "recordings/base/check.h"

#include <ImathBox.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <new>

namespace inlay {

namespace fs = std::filesystem;

namespace {

constexpr int max_side = 16384;                 // px
constexpr std::int64_t max_pixels = 1LL << 27;  // 16384 x 8192, the largest 2:1 map
constexpr std::int64_t max_values = 1LL << 30;  // pixels times channels: 4 GiB of floats
constexpr int max_channels = 1024;

struct Window {
    int left = 0, top = 0, width = 0, height = 0;  // px
};

Window window(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

void require_size(const fs::path& file, const std::string& name, const Imath::Box2i& box) {
    const std::int64_t width = std::int64_t(box.max.x) - box.min.x + 1;
    const std::int64_t height = std::int64_t(box.max.y) - box.min.y + 1;
    require(width >= 1 && height >= 1 && width <= max_side && height <= max_side &&
                width * height <= max_pixels,
            file.string() + ": the " + name + " is " + std::to_string(width) + " x " +
                std::to_string(height) + " px; expected 1 to " + std::to_string(max_side) +
                " px a side and at most " + std::to_string(max_pixels) + " px");
}

/// Reads the rows first..last of a float channel into a buffer as wide as the data window.
void read_rows(Imf::InputFile& exr, const std::string& channel, std::vector<float>& buffer,
               int first, int last) {
    const Window data = window(exr.header().dataWindow());
    buffer.resize(std::size_t(data.width) * std::size_t(last - first + 1));
    Imf::FrameBuffer frame;
    frame.insert(channel, Imf::Slice::Make(Imf::FLOAT, buffer.data(), Imath::V2i(data.left, first),
                                           data.width, last - first + 1, sizeof(float)));
    exr.setFrameBuffer(frame);
    exr.readPixels(first, last);
}

/// A file that lies about its size fails here, before memory for all of it is taken.
void probe_ends(Imf::InputFile& exr, const std::string& channel) {
    const Imath::Box2i& box = exr.header().dataWindow();
    std::vector<float> row;
    for (const int y : {box.max.y, box.min.y})
        read_rows(exr, channel, row, y, y);
}

Image<float> read_channel(Imf::InputFile& exr, const std::string& channel) {
    const Window data = window(exr.header().dataWindow());
    const Window display = window(exr.header().displayWindow());
    std::vector<float> buffer;
    read_rows(exr, channel, buffer, data.top, data.top + data.height - 1);
    Image<float> image(display.width, display.height, 0.0f);
    const int from = std::max(0, data.left - display.left);
    const int to = std::min(display.width, data.left + data.width - display.left);
    for (int y = 0; y < display.height; ++y) {
        const int row = y + display.top - data.top;
        if (row < 0 || row >= data.height || from >= to) continue;
        const float* source = buffer.data() + std::size_t(row) * std::size_t(data.width) +
                              (from + display.left - data.left);
        std::copy_n(source, to - from, image.row(y).begin() + from);
    }
    return image;
}

/// Opens a file, checks what its header claims, and hands it on; turns what OpenEXR throws into
/// Error.
void with_exr(const fs::path& file, const std::function<void(Imf::InputFile&)>& body) {
    std::error_code ignored;
    require(fs::is_regular_file(file, ignored), file.string() + ": no such file",
            ExitCode::input_missing);
    try {
        Imf::Header::setMaxImageSize(max_side, max_side);
        Imf::Header::setMaxTileSize(max_side, max_side);
        Imf::InputFile exr(file.string().c_str());
        require_size(file, "data window", exr.header().dataWindow());
        require_size(file, "display window", exr.header().displayWindow());
        body(exr);
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::bad_data, file.string() + ": too large to be held in memory");
    } catch (const std::exception& fault) {
        throw Error(ExitCode::bad_data, file.string() + ": damaged, cut off, or no EXR file (" +
                                            fault.what() + "); write it again");
    }
}

std::vector<std::string> channel_names(const Imf::Header& header, const fs::path& file) {
    std::vector<std::string> names;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
        require(c.channel().xSampling == 1 && c.channel().ySampling == 1,
                file.string() + ": channel " + c.name() +
                    " is sub-sampled; expected one value per pixel (save it as R, G, B)");
        names.emplace_back(c.name());
    }
    return names;
}

/// The channels that hold red, green and blue.
std::vector<std::string> color_channels(const std::vector<std::string>& names,
                                        const fs::path& file) {
    const auto has = [&](const char* name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (has("R") && has("G") && has("B")) return {"R", "G", "B"};
    std::string found;
    for (const std::string& name : names)
        found += (found.empty() ? "" : ", ") + name;
    require(has("Y"), file.string() + ": holds the channels " + found + "; expected R, G, B or Y");
    return {"Y", "Y", "Y"};
}

}  // namespace

Image<Rgb> read_exr(const fs::path& file) {
    Image<Rgb> image;
    with_exr(file, [&](Imf::InputFile& exr) {
        const auto color = color_channels(channel_names(exr.header(), file), file);
        probe_ends(exr, color[0]);
        for (int c = 0; c < 3; ++c) {
            const Image<float> plane = read_channel(exr, color[std::size_t(c)]);
            if (c == 0) image = Image<Rgb>(plane.width, plane.height);
            for (std::size_t i = 0; i < plane.pixels.size(); ++i)
                image.pixels[i][c] = plane.pixels[i];
        }
    });
    return image;
}

std::vector<ExrChannel> read_exr_channels(const fs::path& file) {
    std::vector<ExrChannel> channels;
    with_exr(file, [&](Imf::InputFile& exr) {
        const std::vector<std::string> names = channel_names(exr.header(), file);
        const Window display = window(exr.header().displayWindow());
        require(names.size() <= max_channels &&
                    std::int64_t(names.size()) * display.width * display.height <= max_values,
                file.string() + ": holds " + std::to_string(names.size()) +
                    " channels; expected at most " + std::to_string(max_channels) + " and 4 GiB");
        for (const std::string& name : names) {
            probe_ends(exr, name);
            channels.push_back({name, read_channel(exr, name)});
        }
    });
    return channels;
}

}  // namespace inlay
