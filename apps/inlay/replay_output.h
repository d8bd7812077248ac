// The folder that a replay writes: run.json, frames.jsonl, pictures, EXR files, and the video.
#pragma once

#include "composite/session/session.h"
#include "recordings/readers/recording.h"

#include "apps/inlay/run_file.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace inlay {

struct ReplayOutput {
    std::filesystem::path folder;
    std::vector<std::string> layers;  // of the EXR files
    std::set<int> finished;           // frames that are there already
};

/// Makes the folder and writes run.json. A folder that holds a run already is refused
/// (cannot_create) unless `resume` is set; then its run must be the same (usage), and its finished
/// frames are kept.
ReplayOutput open_output(const std::filesystem::path& folder, const RecordingInfo& recording,
                         const RunDescription& run, bool resume);

/// What a frame's report says beside what the frame itself tells.
struct FrameNotes {
    double load_ms = 0;
    std::optional<GovernedFrame> governor;
};

/// Writes one frame's files, then its line; returns the line's report.
FrameReport write_frame(ReplayOutput& output, const RgbdFrame& frame, const OutputFrame& composed,
                        const FrameNotes& notes);

/// What a frame's line says; without the times of loading and writing.
FrameReport report_of(int frame, double time, const OutputFrame& composed);

/// Writes report.html: all frames that the folder has finished, with pictures of the first, the
/// middle and the last of them.
void write_report(const ReplayOutput& output, const Recording& recording,
                  const RunDescription& run);

/// A video of the given frames' pictures, which must be there.
void write_video(const ReplayOutput& output, const std::vector<int>& frames,
                 const std::filesystem::path& file, double frames_per_second);

}  // namespace inlay
