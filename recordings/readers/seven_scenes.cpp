#include "recordings/readers/seven_scenes.h"

#include "recordings/base/check.h"
#include "recordings/readers/frame_files.h"
#include "recordings/readers/text_file.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view color_suffixes[] = {".color.png", ".color.jpg", ".color.jpeg"};
constexpr std::string_view depth_suffixes[] = {".depth.png", ".depth.pgm"};
constexpr std::string_view pose_suffixes[] = {".pose.txt"};

std::optional<fs::path> intrinsics_file(const fs::path& folder) {
    for (const fs::path& place : {folder, folder / ".."}) {
        std::error_code error;
        fs::path file = place / "camera-intrinsics.txt";
        if (fs::is_regular_file(file, error)) return file;
    }
    return std::nullopt;
}

/// All numbers of a file, which must be `count`, at most one row of them a line.
std::vector<double> read_matrix(const fs::path& file, std::size_t count, std::size_t columns) {
    std::vector<double> numbers;
    TextLine last;
    for (const TextLine& line : read_lines(file)) {
        if (numbers.size() == count)
            fail_at(file, line, "no more than " + std::to_string(count) + " numbers");
        const auto row = parse_numbers(file, line, columns);
        numbers.insert(numbers.end(), row.begin(), row.end());
        last = line;
    }
    if (numbers.size() != count)
        fail_at(file, last,
                std::to_string(count / columns) + " rows of " + std::to_string(columns) +
                    " numbers, the file ends here");
    return numbers;
}

Lens read_intrinsics(const fs::path& file) {
    const auto k = read_matrix(file, 9, 3);
    const Lens lens{0, 0, k[0], k[4], k[2], k[5]};
    require(std::isfinite(k[0] + k[2] + k[4] + k[5]) && lens.fx > 0 && lens.fy != 0,
            file.string() + ": expected 'fx 0 cx', '0 fy cy', '0 0 1' with fx above 0");
    return lens;
}

void set_lens(RecordingInfo& info, const OpenOptions& options) {
    if (const auto file = intrinsics_file(info.path)) {
        info.lens = read_intrinsics(*file);
        info.assumptions.push_back("lens from " + file->lexically_normal().string() +
                                   ", without distortion");
        return;
    }
    require(options.profile != "3dmatch" || options.lens,
            info.path.string() +
                ": found no camera-intrinsics.txt in it or one level up; give the "
                "lens with --lens fx,fy,cx,cy");
    info.lens = {640, 480, 585, 585, 320, 240};
    info.warnings.push_back("lens 585,585,320,240 assumed: the files name none");
}

/// A pose file that is not 16 numbers spoils its own frame's pose and nothing else.
CheckedPose read_pose(const fs::path& file) {
    try {
        const auto numbers = read_matrix(file, 16, 4);
        return pose_from_rows(std::span<const double, 16>(numbers.data(), 16));
    } catch (const Error& error) {
        return {{}, error.what()};
    }
}

void set_poses(std::vector<FrameFiles>& frames, RecordingInfo& info) {
    const auto files = numbered_files(info.path, "frame-", pose_suffixes);
    if (!files.empty()) info.pose_source = "frame-*.pose.txt, camera-to-world";
    for (const NumberedFile& file : files) {
        const auto at = std::ranges::lower_bound(frames, file.number, {}, &FrameFiles::number);
        if (at != frames.end() && at->number == file.number)
            at->world_from_camera = read_pose(file.path);
    }
}

void set_up(RecordingInfo& info) {
    const fs::path file = info.path / "gravity-direction.txt";
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return;
    std::vector<double> down;
    TextLine last;
    for (const TextLine& line : read_lines(file)) {
        for (const std::string_view word : words(line.text)) {
            const auto number = parse_number(word);
            if (!number) fail_at(file, line, "the three numbers of a direction");
            down.push_back(*number);
        }
        last = line;
    }
    const bool three = down.size() == 3;
    const glm::dvec3 direction = three ? glm::dvec3(down[0], down[1], down[2]) : glm::dvec3(0);
    const double length = glm::length(direction);
    if (!(length > 0.5 && length < 2)) fail_at(file, last, "a unit direction of three numbers");
    info.up = -direction / length;
    info.assumptions.push_back("gravity-direction.txt points down, in the world of the poses");
}

}  // namespace

bool recognises_seven_scenes(const fs::path& folder) {
    return !numbered_files(folder, "frame-", color_suffixes).empty();
}

bool recognises_three_d_match(const fs::path& folder) {
    return recognises_seven_scenes(folder) && intrinsics_file(folder).has_value();
}

Recording open_seven_scenes(const fs::path& folder, const OpenOptions& options) {
    RecordingInfo info;
    info.path = folder;
    set_lens(info, options);
    auto frames = pair_by_number(numbered_files(folder, "frame-", color_suffixes),
                                 numbered_files(folder, "frame-", depth_suffixes), info);
    set_poses(frames, info);
    set_up(info);
    info.assumptions.emplace_back("depth in mm");
    info.warnings.emplace_back(
        "Kinect recordings of this layout store color and depth as two unregistered views, 25 mm "
        "apart: expect edges to disagree by several pixels");
    return make_recording(std::move(info), std::move(frames), options);
}

}  // namespace inlay
