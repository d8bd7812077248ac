#include "recordings/readers/tum_rgbd.h"

#include "recordings/base/check.h"
#include "recordings/readers/frame_files.h"
#include "recordings/readers/pairing.h"
#include "recordings/readers/text_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr std::int64_t pairing_tolerance = 20'000'000;  // ns, as the data set's own script

struct KnownLens {
    const char* long_name = "";
    const char* short_name = "";
    Lens lens;
};

/// The color cameras' own calibrations, from the data set's page.
const KnownLens known_lenses[] = {
    {"freiburg1",
     "fr1",
     {640, 480, 517.3, 516.5, 318.6, 255.3, 0.2624, -0.9531, 1.1633, -0.0054, 0.0026}},
    {"freiburg2",
     "fr2",
     {640, 480, 520.9, 521.0, 325.1, 249.7, 0.2312, -0.7849, 0.9172, -0.0033, -0.0001}},
    {"freiburg3", "fr3", {640, 480, 535.4, 539.2, 320.1, 247.6}},
};

struct StampedFile {
    std::int64_t time_ns = 0;
    fs::path path;
};

/// A path of a list stays within the recording.
bool inside(const fs::path& relative) {
    return relative.is_relative() &&
           std::ranges::none_of(relative, [](const fs::path& part) { return part == ".."; });
}

std::vector<StampedFile> read_list(const fs::path& file, RecordingInfo& info) {
    std::vector<StampedFile> files;
    bool backwards = false;
    for (const TextLine& line : read_lines(file)) {
        const auto found = words(line.text);
        const auto time = found.size() == 2 ? parse_time_ns(found[0]) : std::nullopt;
        if (!time) fail_at(file, line, "'stamp path' with the stamp in decimal seconds");
        const fs::path path(found[1]);
        if (!inside(path)) fail_at(file, line, "a path below the recording's folder");
        backwards = backwards || (!files.empty() && *time < files.back().time_ns);
        files.push_back({*time, info.path / path});
    }
    if (backwards) {
        std::ranges::stable_sort(files, {}, &StampedFile::time_ns);
        info.warnings.push_back(file.string() + ": time goes backwards; rows were sorted");
    }
    return files;
}

std::vector<std::int64_t> stamps(const std::vector<StampedFile>& files) {
    std::vector<std::int64_t> times;
    times.reserve(files.size());
    for (const StampedFile& file : files)
        times.push_back(file.time_ns);
    return times;
}

std::vector<FrameFiles> list_frames(RecordingInfo& info) {
    const auto color = read_list(info.path / "rgb.txt", info);
    const auto depth = read_list(info.path / "depth.txt", info);
    std::vector<FrameFiles> frames;
    std::int64_t farthest = 0;
    for (const TimePair& pair : pair_by_time(stamps(color), stamps(depth), pairing_tolerance)) {
        const StampedFile& image = color[std::size_t(pair.a)];
        const StampedFile& partner = depth[std::size_t(pair.b)];
        farthest = std::max(farthest, std::abs(image.time_ns - partner.time_ns));
        frames.push_back({int(frames.size()), image.time_ns, image.path, partner.path, {}});
    }
    char apart[32];
    std::snprintf(apart, sizeof apart, "%.1f ms", double(farthest) * 1e-6);
    info.assumptions.push_back("paired by time within 20 ms: " + std::to_string(frames.size()) +
                               " pairs of " + std::to_string(color.size()) + " color and " +
                               std::to_string(depth.size()) + " depth images, at most " + apart +
                               " apart");
    return frames;
}

/// Whether `name` stands in the text as a word of its own.
bool mentions(const std::string& text, const std::string& name) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + 1)) {
        const char before = at > 0 ? text[at - 1] : ' ';
        const std::size_t end = at + name.size();
        const char after = end < text.size() ? text[end] : ' ';
        if (!std::isalnum(static_cast<unsigned char>(before)) &&
            !std::isalnum(static_cast<unsigned char>(after)))
            return true;
    }
    return false;
}

/// The folder's name and what the lists say they were made from.
std::string traces_of_origin(const fs::path& folder) {
    std::string text = (fs::absolute(folder) / "").lexically_normal().parent_path().filename();
    for (const std::string& comment : read_comments(folder / "rgb.txt"))
        text += "\n" + comment;
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

/// The data set's camera that this recording comes from; null for any other recording.
const KnownLens* known_camera(const fs::path& folder) {
    const std::string origin = traces_of_origin(folder);
    for (const KnownLens& known : known_lenses)
        if (mentions(origin, known.long_name) || mentions(origin, known.short_name)) return &known;
    return nullptr;
}

void set_lens(RecordingInfo& info) {
    info.units_per_metre = 5000;
    info.assumptions.emplace_back("depth in 1/5000 m");
    if (const KnownLens* known = known_camera(info.path)) {
        info.lens = known->lens;
        info.assumptions.push_back(std::string("lens of ") + known->long_name +
                                   ", by the recording's name");
        return;
    }
    info.lens = {640, 480, 525, 525, 319.5, 239.5};
    info.warnings.emplace_back("lens 525,525,319.5,239.5 assumed: the files name none");
}

/// A side length (px); anything else becomes 0, which the caller refuses.
int side(const nlohmann::json& value) {
    const auto length = value.get<double>();
    return length >= 1 && length <= 16384 ? int(length) : 0;
}

void apply_camera_json(const nlohmann::json& json, RecordingInfo& info) {
    require(json.is_object(), (info.path / "camera.json").string() + ": expected an object {...}");
    if (json.contains("lens")) {
        const auto l = json.at("lens").get<std::array<double, 4>>();
        info.lens = {side(json.at("width")), side(json.at("height")), l[0], l[1], l[2], l[3]};
        replace_notes(info, "lens", "lens from camera.json");
    }
    if (json.contains("distortion")) {
        const auto d = json.at("distortion").get<std::array<double, 5>>();
        info.lens.k1 = d[0], info.lens.k2 = d[1], info.lens.p1 = d[2], info.lens.p2 = d[3];
        info.lens.k3 = d[4];
    }
    if (json.contains("depth_scale")) {
        info.units_per_metre = json.at("depth_scale").get<double>();
        replace_notes(info, "depth", "depth scale from camera.json");
    }
    if (json.contains("up")) {
        const auto up = json.at("up").get<std::array<double, 3>>();
        info.up = glm::dvec3(up[0], up[1], up[2]);
    }
}

/// What `inlay record` writes beside its lists overrides what is known of the data set.
void read_camera_json(RecordingInfo& info) {
    const fs::path file = info.path / "camera.json";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    try {
        apply_camera_json(nlohmann::json::parse(read_bytes(file, 1 << 20)), info);
    } catch (const nlohmann::json::exception& failure) {
        throw Error(ExitCode::bad_data, file.string() + ": " + failure.what());
    }
    const Lens& lens = info.lens;
    require(lens.width > 0 && lens.height > 0 && lens.fx > 0 && lens.fy != 0,
            file.string() + ": expected width, height and fx above 0, and fy other than 0");
    require(std::isfinite(info.units_per_metre) && info.units_per_metre > 0,
            file.string() + ": expected 'depth_scale' in units per metre, above 0");
    if (info.up) {
        require(glm::length(*info.up) > 0, file.string() + ": expected 'up' other than 0 0 0");
        info.up = glm::normalize(*info.up);
    }
}

void set_poses(std::vector<FrameFiles>& frames, RecordingInfo& info) {
    const fs::path file = info.path / "groundtruth.txt";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    const Trajectory trajectory = read_tum_trajectory(file);
    info.warnings.insert(info.warnings.end(), trajectory.warnings.begin(),
                         trajectory.warnings.end());
    info.pose_source = "groundtruth.txt, camera-to-world, interpolated at the color stamps";
    for (FrameFiles& frame : frames)
        frame.world_from_camera = interpolate_at(trajectory, frame.time_ns);
    if (info.up || !known_camera(info.path)) return;
    info.up = {0, 0, 1};
    info.assumptions.emplace_back("up is +z of the motion capture's world");
}

}  // namespace

bool recognises_tum(const fs::path& folder) {
    std::error_code error;
    return fs::is_regular_file(folder / "rgb.txt", error) &&
           fs::is_regular_file(folder / "depth.txt", error);
}

Recording open_tum(const fs::path& folder, const OpenOptions& options) {
    RecordingInfo info;
    info.path = folder;
    set_lens(info);
    read_camera_json(info);
    auto frames = list_frames(info);
    set_poses(frames, info);
    return make_recording(std::move(info), std::move(frames), options);
}

}  // namespace inlay
