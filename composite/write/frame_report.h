// FrameReport: the line per finished frame in frames.jsonl.
#pragma once

#include "recordings/base/pose.h"
#include "render/trace/ray_counts.h"
#include "slam/track/track_frame.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// Wall time of a frame's stages, ms.
struct StageTimes {
    double load = 0, slam = 0, plan = 0, trace = 0, filter = 0, composite = 0, write = 0, total = 0;
};

struct PixelCounts {
    std::uint64_t virtual_ = 0;    // covered by a virtual object, at least in part
    std::uint64_t influenced = 0;  // written bytes differ from the recorded ones
    std::uint64_t skipped = 0;     // no real-geometry ray was traced
};

/// What a governor chose for a frame, and what it expected; expectations only where it did choose.
struct GovernedFrame {
    int samples = 0;  // light samples per pixel
    std::optional<double> expected_ms{}, expected_error{};
    std::optional<double> estimated_error{};  // without truth, in the frames that are checked
    double check_ms = 0;                      // what the estimate took, beside the frame's own time
};

/// "tracked", "weak" or "lost", as the files of a run have it.
const char* name_of(TrackingStatus status);

struct FrameReport {
    int frame = 0;    // the recording's own number
    double time = 0;  // s since the recording's first frame
    TrackingStatus tracking = TrackingStatus::tracked;
    Pose world_from_camera{};  // of the camera that took the photograph
    glm::vec3 exposure{1};     // of the photograph, relative to that of the model's colors, per
                               // channel; in the line only where it is not 1
    StageTimes ms{};
    RayCounts rays{};  // as times are, more in the frame that is the first to ask for the light on
                       // a finished model, which others find there
    PixelCounts pixels{};
    std::uint64_t dropped_samples = 0;  // not finite, left out of every mean
    std::uint64_t replaced_pixels = 0;  // a term was not finite: the photograph stands in
    std::vector<std::string> plan{};    // the effects that were simulated
    std::optional<GovernedFrame> governor{};
};

/// One line of JSON without its line end; numbers read back to the same bits.
std::string to_json_line(const FrameReport& report);

/// The report in a line. Throws Error (bad_data); `place` names the line in the message.
FrameReport from_json_line(const std::string& line, const std::string& place);

/// Appends a line and syncs it to disk. An unfinished last line, left by an interrupted run, is
/// cut off first; when the disk is full the file is left as it was. Throws Error (disk_fault,
/// cannot_create).
void append_report(const std::filesystem::path& file, const FrameReport& report);

/// All reports of a file, in its order; none when there is no such file. A last line without its
/// end was interrupted and is ignored; any other damage throws Error (bad_data) naming the line.
std::vector<FrameReport> read_reports(const std::filesystem::path& file);

}  // namespace inlay
