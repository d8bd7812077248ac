#include "recordings/readers/frame_files.h"

#include "recordings/base/check.h"
#include "recordings/readers/image_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr double synthetic_rate = 30;  // frames per second
constexpr int headers_to_try = 10;     // frames whose files are damaged before giving up

std::string lower_case(std::string text) {
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// The digits at the end of a name and what is before them.
std::pair<std::string_view, std::string_view> split_trailing_digits(std::string_view name) {
    std::size_t at = name.size();
    while (at > 0 && std::isdigit(static_cast<unsigned char>(name[at - 1])))
        --at;
    return {name.substr(0, at), name.substr(at)};
}

/// Number and stamp from a name without its suffix; empty if it is not of the form.
std::optional<NumberedFile> parse_name(std::string_view stem, std::string_view prefix) {
    auto [before, digits] = split_trailing_digits(stem);
    NumberedFile file;
    if (prefix.empty() && before.ends_with('-')) {
        const auto [outer, number] = split_trailing_digits(before.substr(0, before.size() - 1));
        if (!number.empty() && digits.size() >= 9 && digits.size() <= 15) {
            file.time_ns = std::stoll(std::string(digits)) * 1000;
            digits = number;
            before = outer;
        }
    }
    const bool fits = prefix.empty() || before == prefix;
    if (!fits || digits.empty() || digits.size() > 9) return std::nullopt;
    file.number = std::stoi(std::string(digits));
    return file;
}

std::vector<int> numbers_without_partner(const std::vector<NumberedFile>& files,
                                         const std::map<int, fs::path>& partners) {
    std::vector<int> alone;
    for (const NumberedFile& file : files)
        if (!partners.contains(file.number)) alone.push_back(file.number);
    return alone;
}

std::map<int, fs::path> by_number(const std::vector<NumberedFile>& files) {
    std::map<int, fs::path> map;
    for (const NumberedFile& file : files)
        map.emplace(file.number, file.path);
    return map;
}

void leave_out_missing(std::vector<FrameFiles>& frames, RecordingInfo& info) {
    std::vector<int> missing;
    std::string first;
    std::erase_if(frames, [&](const FrameFiles& frame) {
        for (const fs::path& file : {frame.color, frame.depth}) {
            std::error_code error;
            if (fs::is_regular_file(file, error)) continue;
            if (missing.empty()) first = file.string();
            missing.push_back(frame.number);
            return true;
        }
        return false;
    });
    if (!missing.empty())
        info.warnings.push_back(count_and_name(missing) + " left out: image files are missing (" +
                                first + ")");
}

/// The size of the first frame whose headers can be read.
glm::ivec2 size_of_images(const std::vector<FrameFiles>& frames) {
    std::optional<Error> first_error;
    for (std::size_t i = 0; i < frames.size() && i < headers_to_try; ++i) {
        ImageHeader color, depth;
        try {
            color = read_image_header(frames[i].color);
            depth = read_image_header(frames[i].depth);
            require_depth_format(frames[i].depth, depth);
        } catch (const Error& error) {
            if (!first_error) first_error = error;
            continue;
        }
        require(color.width == depth.width && color.height == depth.height,
                frames[i].depth.string() + ": depth has " + std::to_string(depth.width) + " x " +
                    std::to_string(depth.height) + " px, its color image " +
                    std::to_string(color.width) + " x " + std::to_string(color.height) +
                    "; registration of depth to color is not available: give a recording whose "
                    "depth is registered");
        return {color.width, color.height};
    }
    throw Error(first_error.value());
}

void fit_lens(RecordingInfo& info, const glm::ivec2& size, const OpenOptions& options) {
    Lens& lens = info.lens;
    if (options.lens) {
        lens = {size.x, size.y, options.lens->x, options.lens->y, options.lens->z, options.lens->w};
        replace_notes(info, "lens", "lens as given by the options");
    }
    if (lens.width == 0) lens.width = size.x, lens.height = size.y;
    if (lens.width != size.x || lens.height != size.y) {
        const double stretch = double(size.x) * lens.height / (double(size.y) * lens.width);
        require(std::abs(stretch - 1) < 0.01,
                info.path.string() + ": the images have " + std::to_string(size.x) + " x " +
                    std::to_string(size.y) + " px, the known lens is for " +
                    std::to_string(lens.width) + " x " + std::to_string(lens.height) +
                    "; give the lens with --lens fx,fy,cx,cy");
        info.warnings.push_back("lens scaled from " + std::to_string(lens.width) + " to " +
                                std::to_string(size.x) + " px of width");
        lens = scaled(lens, size.x, size.y);
    }
    if (!options.distortion) return;
    const auto& d = *options.distortion;
    lens.k1 = d[0], lens.k2 = d[1], lens.p1 = d[2], lens.p2 = d[3], lens.k3 = d[4];
}

void fill_frames(RecordingInfo& info, const std::vector<FrameFiles>& frames) {
    std::vector<int> without, unusable;
    std::string first_fault;
    if (!info.synthetic_times && !frames.empty()) info.first_time_ns = frames.front().time_ns;
    for (const FrameFiles& frame : frames) {
        info.frames.push_back(frame.number);
        info.times.push_back(double(frame.time_ns - frames.front().time_ns) * 1e-9);
        const auto& pose = frame.world_from_camera;
        info.world_from_camera.emplace_back();
        if (!pose) without.push_back(frame.number);
        if (pose && pose->usable()) info.world_from_camera.back() = pose->pose;
        if (!pose || pose->usable()) continue;
        if (unusable.empty()) first_fault = pose->fault;
        unusable.push_back(frame.number);
    }
    if (!std::ranges::is_sorted(info.times))
        info.warnings.emplace_back("time goes backwards from one frame to the next");
    info.unusable_poses = int(unusable.size());
    if (!unusable.empty())
        info.warnings.push_back("the pose of " + count_and_name(unusable) +
                                " is unusable: " + first_fault);
    const bool some = without.size() < frames.size();
    if (some && !without.empty())
        info.warnings.push_back(count_and_name(without) + " without a recorded pose");
    if (!some && info.up) {
        info.up.reset();
        info.warnings.push_back("the up direction is unused: no frame has a pose it refers to");
    }
}

struct Loader {
    std::vector<FrameFiles> frames;  // by number
    RecordingInfo info;

    RgbdFrame operator()(int number) const {
        const auto at = std::ranges::lower_bound(frames, number, {}, &FrameFiles::number);
        require(at != frames.end() && at->number == number,
                info.path.string() + ": has no frame " + std::to_string(number));
        const auto place = std::size_t(at - frames.begin());
        RgbdFrame frame;
        frame.index = number;
        frame.time = info.times[place];
        frame.lens = info.lens;
        frame.color = read_color(at->color);
        frame.depth = read_depth(at->depth, info.units_per_metre, info.max_depth);
        frame.recorded_world_from_camera = info.world_from_camera[place];
        check_size(at->color, frame.color.width, frame.color.height);
        check_size(at->depth, frame.depth.width, frame.depth.height);
        return frame;
    }

    void check_size(const fs::path& file, int width, int height) const {
        require(width == info.lens.width && height == info.lens.height,
                file.string() + ": found " + std::to_string(width) + " x " +
                    std::to_string(height) + " px, expected " + std::to_string(info.lens.width) +
                    " x " + std::to_string(info.lens.height) + " as in the first frame");
    }
};

}  // namespace

std::vector<NumberedFile> numbered_files(const fs::path& folder, std::string_view prefix,
                                         std::span<const std::string_view> suffixes) {
    std::vector<NumberedFile> files;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        const std::string lower = lower_case(name);
        for (const std::string_view suffix : suffixes) {
            if (!lower.ends_with(suffix)) continue;
            const std::string_view stem(name.data(), name.size() - suffix.size());
            if (auto file = parse_name(stem, prefix)) {
                file->path = entry.path();
                files.push_back(*file);
            }
            break;
        }
    }
    std::ranges::sort(files, {}, &NumberedFile::path);
    std::ranges::stable_sort(files, {}, &NumberedFile::number);
    const auto same = [](const auto& a, const auto& b) { return a.number == b.number; };
    files.erase(std::unique(files.begin(), files.end(), same), files.end());
    return files;
}

std::vector<FrameFiles> pair_by_number(const std::vector<NumberedFile>& color,
                                       const std::vector<NumberedFile>& depth,
                                       RecordingInfo& info) {
    const auto color_of = by_number(color), depth_of = by_number(depth);
    if (const auto alone = numbers_without_partner(color, depth_of); !alone.empty())
        info.warnings.push_back(count_and_name(alone) + " left out: no depth file");
    if (const auto alone = numbers_without_partner(depth, color_of); !alone.empty())
        info.warnings.push_back(count_and_name(alone) + " left out: no color file");
    std::vector<FrameFiles> frames;
    for (const auto& [number, file] : color_of) {
        const auto partner = depth_of.find(number);
        if (partner == depth_of.end()) continue;
        const std::int64_t time_ns = std::llround(number * 1e9 / synthetic_rate);
        frames.push_back({number, time_ns, file, partner->second, {}});
    }
    info.synthetic_times = true;
    info.assumptions.push_back("times are synthetic: the files carry none, 30 frames a second");
    return frames;
}

Recording make_recording(RecordingInfo info, std::vector<FrameFiles> frames,
                         const OpenOptions& options) {
    leave_out_missing(frames, info);
    require(!frames.empty(), info.path.string() +
                                 ": found no frame with both a color and a depth image; expected "
                                 "one or more");
    if (options.depth_scale) {
        info.units_per_metre = *options.depth_scale;
        replace_notes(info, "depth", "depth scale as given by the options");
    }
    if (options.max_depth) info.max_depth = *options.max_depth;
    fit_lens(info, size_of_images(frames), options);
    fill_frames(info, frames);
    auto loader = std::make_shared<Loader>();
    loader->frames = std::move(frames);
    loader->info = info;
    return {std::move(info), [loader](int number) { return (*loader)(number); }};
}

void replace_notes(RecordingInfo& info, const std::string& subject, const std::string& note) {
    const auto about = [&](const std::string& text) { return text.starts_with(subject); };
    std::erase_if(info.warnings, about);
    std::erase_if(info.assumptions, about);
    info.assumptions.push_back(note);
}

std::string count_and_name(const std::vector<int>& numbers) {
    std::string text =
        std::to_string(numbers.size()) + (numbers.size() == 1 ? " frame (" : " frames (");
    for (std::size_t i = 0; i < numbers.size() && i < 5; ++i)
        text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
    return text + (numbers.size() > 5 ? ", ...)" : ")");
}

}  // namespace inlay
