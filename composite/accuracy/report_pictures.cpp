#include "composite/accuracy/report_pictures.h"

#include "composite/blend/differential.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace inlay {
namespace {

/// Letters of base 64 (RFC 4648), three bytes at a time.
std::string base64(std::span<const std::byte> bytes) {
    constexpr const char* letters =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? std::uint32_t(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? letters[group >> (18 - 6 * k) & 63U] : '=';
    }
    return text;
}

std::string file_name(const std::string& cell) {
    std::string name = cell;
    std::replace(name.begin(), name.end(), '/', '.');
    return name + ".png";
}

class Album {
public:
    Album(const Work& work, int frame, const std::filesystem::path& folder)
        : folder_(folder / "pictures" / work.name), frame_(frame) {
        make_folder(folder_);
    }

    void add(const std::string& cell, const std::string& title, const Image<EncodedRgb>& picture) {
        const std::vector<std::byte> png = encode_png(picture);
        write_file(folder_ / file_name(cell), png);
        pictures.push_back({cell, title, frame_, data_url(png)});
    }

    std::vector<ReportPicture> pictures;

private:
    std::filesystem::path folder_;
    int frame_;
};

bool is_shown(const Cell& cell) {
    if (!cell.failed.empty() || cell.knob != "samples") return false;
    return cell.value == "16" || (cell.value == "64" && cell.method == "unfiltered");
}

/// The samples of one setting, for all the methods that are shown at it.
struct Shown {
    Estimator estimator = Estimator::two_mode;
    int primary = 0, secondary = 0;
    SampledFrame now;
    std::optional<SampledFrame> previous;
};

Shown sample(const Work& work, const JudgedFrame& frame, const Cell& cell,
             const Settings& settings) {
    Shown shown;
    shown.primary = cell.primary;
    shown.secondary = cell.secondary;
    SamplingSettings sampling = settings.trace;
    shown.estimator = sampling.estimator = method_named(cell.method).estimator;
    sampling.primary = cell.primary;
    sampling.secondary = cell.secondary;
    sampling.unshadowed = true;  // for the methods that ask for it
    const auto index = std::uint32_t(frame.now.frame);
    shown.now = sample_frame(work, frame.now, sampling, index);
    if (frame.previous) shown.previous = sample_frame(work, *frame.previous, sampling, index - 1);
    return shown;
}

std::string title_of(const Cell& cell) {
    return fmt::format("{}, {} samples{}", method_named(cell.method).title,
                       cell.primary * cell.secondary, cell.temporal ? ", previous frame" : "");
}

}  // namespace

std::string data_url(std::span<const std::byte> png) {
    return "data:image/png;base64," + base64(png);
}

std::vector<ReportPicture> report_pictures(const Work& work, const JudgedFrame& frame,
                                           const std::vector<Cell>& cells, const Settings& settings,
                                           const std::filesystem::path& folder) {
    Album album(work, frame.now.frame, folder);
    album.add("photograph", "Photograph", frame.now.photo->encoded);
    if (frame.truth) album.add("truth", "Truth", encode(frame.truth->linear));
    if (frame.converged) album.add("converged", "Converged", encode(frame.converged->linear));
    std::optional<Shown> shown;
    for (const Cell& cell : cells) {
        if (!is_shown(cell)) continue;
        if (!shown || shown->primary != cell.primary || shown->secondary != cell.secondary ||
            shown->estimator != method_named(cell.method).estimator)
            shown = sample(work, frame, cell, settings);
        const NoisyLayers* previous =
            cell.temporal && shown->previous ? &shown->previous->result.layers : nullptr;
        const Layers layers =
            method_named(cell.method)
                .apply({shown->now.result.layers, previous, work.environment_bandwidth,
                        settings.filter, work.open_sky, cell.width.value_or(0)});
        album.add(cell.id, title_of(cell),
                  composite(*frame.now.photo, layers, settings.blend).display);
    }
    return std::move(album.pictures);
}

}  // namespace inlay
