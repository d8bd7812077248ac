// What all readers of image folders share: files found by number, and the step from a list of
// files to a Recording.
#pragma once

#include "recordings/readers/recording.h"
#include "recordings/readers/trajectory.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace inlay {

struct NumberedFile {
    int number = 0;
    std::optional<std::int64_t> time_ns;  // from names like 0000012-000000400400 (microseconds)
    std::filesystem::path path;
};

/// The files `PREFIX<digits>SUFFIX` of a folder, by number; an empty prefix allows any. Of two
/// files with the same number the first by name stays. Suffixes are compared in lower case.
std::vector<NumberedFile> numbered_files(const std::filesystem::path& folder,
                                         std::string_view prefix,
                                         std::span<const std::string_view> suffixes);

/// One frame before it is decoded.
struct FrameFiles {
    int number = 0;
    std::int64_t time_ns = 0;
    std::filesystem::path color, depth;
    std::optional<CheckedPose> world_from_camera;
};

/// Pairs color and depth files of equal number; those without a partner are left out with a
/// warning in `info`. Times are the numbers at 30 a second.
std::vector<FrameFiles> pair_by_number(const std::vector<NumberedFile>& color,
                                       const std::vector<NumberedFile>& depth, RecordingInfo& info);

/// The recording of these frames: applies the options, leaves out frames whose files are missing,
/// sets the lens's size from the first image (a lens for another size is scaled), and counts
/// poses. Throws Error (bad_data) where nothing is left, or where color and depth differ in size.
Recording make_recording(RecordingInfo info, std::vector<FrameFiles> frames,
                         const OpenOptions& options);

/// Takes out what was said about a subject ("lens", "depth") that something else now decides, and
/// says so instead.
void replace_notes(RecordingInfo& info, const std::string& subject, const std::string& note);

/// "3 frames (4, 17, 90)": at most five are named.
std::string count_and_name(const std::vector<int>& numbers);

}  // namespace inlay
