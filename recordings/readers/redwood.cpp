#include "recordings/readers/redwood.h"

#include "recordings/base/check.h"
#include "recordings/readers/frame_files.h"
#include "recordings/readers/pairing.h"
#include "recordings/readers/text_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view color_suffixes[] = {".jpg", ".jpeg", ".png", ".ppm"};
constexpr std::string_view depth_suffixes[] = {".png", ".pgm"};
constexpr std::int64_t pairing_tolerance = 20'000'000;  // ns

std::optional<fs::path> color_folder(const fs::path& folder) {
    for (const char* name : {"color", "image", "rgb"}) {
        std::error_code error;
        if (fs::is_directory(folder / name, error)) return folder / name;
    }
    return std::nullopt;
}

std::vector<fs::path> logs_in(const fs::path& folder) {
    std::vector<fs::path> logs;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".log") logs.push_back(entry.path());
    std::ranges::sort(logs);
    return logs;
}

/// trajectory.log, or the only .log, of the folder itself, then of the folders in it.
std::optional<fs::path> trajectory_file(const fs::path& folder) {
    std::vector<fs::path> places;
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.is_directory()) places.push_back(entry.path());
    std::ranges::sort(places);
    places.insert(places.begin(), folder);
    for (const fs::path& place : places) {
        const auto logs = logs_in(place);
        for (const fs::path& log : logs)
            if (log.filename() == "trajectory.log") return log;
        if (logs.size() == 1) return logs.front();
    }
    return std::nullopt;
}

Lens read_lens(const fs::path& file) {
    try {
        const auto json = nlohmann::json::parse(read_bytes(file, 1 << 20));
        const auto k = json.at("intrinsic_matrix").get<std::vector<double>>();
        const auto width = json.at("width").get<double>(), height = json.at("height").get<double>();
        require(width >= 1 && width <= 16384 && height >= 1 && height <= 16384,
                file.string() + ": expected width and height from 1 to 16384 px");
        require(k.at(0) > 0 && k.at(4) != 0, file.string() + ": expected fx above 0");
        return {int(width), int(height), k.at(0), k.at(4), k.at(6), k.at(7)};
    } catch (const nlohmann::json::exception& error) {
        throw Error(ExitCode::bad_data, file.string() + ": " + error.what());
    } catch (const std::out_of_range&) {
        throw Error(ExitCode::bad_data,
                    file.string() + ": expected 9 numbers in 'intrinsic_matrix', column by column");
    }
}

void set_lens(RecordingInfo& info) {
    for (const char* name : {"camera_intrinsic.json", "camera.json"}) {
        std::error_code error;
        const fs::path file = info.path / name;
        if (!fs::is_regular_file(file, error)) continue;
        info.lens = read_lens(file);
        info.assumptions.push_back("lens from " + file.string() + ", without distortion");
        return;
    }
    info.lens = {640, 480, 525, 525, 319.5, 239.5};
    info.assumptions.emplace_back("lens 525,525,319.5,239.5: the files name none");
}

std::vector<std::int64_t> stamps(const std::vector<NumberedFile>& files) {
    std::vector<std::int64_t> times;
    for (const NumberedFile& file : files)
        if (file.time_ns) times.push_back(*file.time_ns);
    return times;
}

std::vector<FrameFiles> list_frames(RecordingInfo& info, const std::vector<NumberedFile>& color) {
    const auto depth = numbered_files(info.path / "depth", "", depth_suffixes);
    const auto color_times = stamps(color), depth_times = stamps(depth);
    const bool timed =
        !color.empty() && color_times.size() == color.size() && depth_times.size() == depth.size();
    if (!timed) return pair_by_number(color, depth, info);
    std::vector<FrameFiles> frames;
    for (const TimePair& pair : pair_by_time(color_times, depth_times, pairing_tolerance)) {
        const NumberedFile& image = color[std::size_t(pair.a)];
        frames.push_back(
            {image.number, *image.time_ns, image.path, depth[std::size_t(pair.b)].path, {}});
    }
    info.assumptions.push_back(
        "paired by the stamps in the file names within 0.02 s: " + std::to_string(frames.size()) +
        " of " + std::to_string(color.size()) + " color and " + std::to_string(depth.size()) +
        " depth images");
    return frames;
}

/// The index of a logged pose counts the color images in numeric order.
void set_poses(std::vector<FrameFiles>& frames, const std::vector<NumberedFile>& color,
               RecordingInfo& info) {
    const auto file = trajectory_file(info.path);
    if (!file) return;
    auto poses = read_log_trajectory(*file);
    info.pose_source = fs::relative(*file, info.path).string() + ", camera-to-world";
    const bool rising = std::ranges::adjacent_find(poses, [](const auto& a, const auto& b) {
                            return b.index <= a.index;
                        }) == poses.end();
    if (!rising) {
        info.warnings.push_back(file->string() +
                                ": its frame indices do not rise; rows were counted instead");
        for (std::size_t i = 0; i < poses.size(); ++i)
            poses[i].index = int(i);
    }
    if (!color.empty() && color.front().number != 0)
        info.assumptions.push_back("index 0 of " + file->filename().string() + " is frame " +
                                   std::to_string(color.front().number));
    for (const LoggedPose& logged : poses) {
        if (std::size_t(logged.index) >= color.size()) continue;
        const int number = color[std::size_t(logged.index)].number;
        const auto at = std::ranges::lower_bound(frames, number, {}, &FrameFiles::number);
        if (at != frames.end() && at->number == number)
            at->world_from_camera = logged.world_from_camera;
    }
}

}  // namespace

bool recognises_redwood(const fs::path& folder) {
    std::error_code error;
    return color_folder(folder) && fs::is_directory(folder / "depth", error);
}

Recording open_redwood(const fs::path& folder, const OpenOptions& options) {
    const auto colors = color_folder(folder);
    std::error_code error;
    require(colors && fs::is_directory(folder / "depth", error),
            folder.string() + ": expected the folders depth/ and one of color/, image/, rgb/");
    RecordingInfo info;
    info.path = folder;
    set_lens(info);
    const auto color = numbered_files(*colors, "", color_suffixes);
    auto frames = list_frames(info, color);
    set_poses(frames, color, info);
    info.assumptions.emplace_back("depth in mm");
    if (fs::exists(folder / "associations.txt", error))
        info.warnings.emplace_back(
            "associations.txt lies beside the images, as in ICL-NUIM's packages: those need "
            "--depth-scale 5000 --lens 481.2,480,319.5,239.5 (or fy -480)");
    return make_recording(std::move(info), std::move(frames), options);
}

}  // namespace inlay
