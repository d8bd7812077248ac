// Groups of options that several commands share.
#pragma once

#include "recordings/readers/recording.h"

#include "apps/inlay/frame_list.h"
#include <CLI/App.hpp>

#include <cstdint>
#include <string>

namespace inlay {

/// What every command understands.
struct CommonOptions {
    std::string frames = "all";  // see parse_frames
    int threads = 0;             // 0 = all cores
    std::uint32_t seed = 1;
    bool quiet = false;  // no progress, no notes; errors still appear
    bool json = false;   // a machine-readable result on stdout
};

/// What every command that reads a recording understands.
struct RecordingOptions {
    std::string path;
    std::string profile;     // "" = found by signature
    std::string lens;        // "fx,fy,cx,cy"
    std::string distortion;  // "k1,k2,p1,p2,k3"
    double depth_scale = 0;  // units per metre; 0 = the profile's
    double max_depth = -1;   // m; below 0 = the recording's
};

/// The options refer to `options`, which must outlive the parsing.
void add_common_options(CLI::App& subcommand, CommonOptions& options);
void add_recording_options(CLI::App& subcommand, RecordingOptions& options);

/// Sets the number of threads and how much is said. Call once, after parsing.
void apply(const CommonOptions& options);

/// Throws Error (usage) for lists of numbers that are none.
OpenOptions open_options(const RecordingOptions& options);

/// Opens the recording and notes its profile, assumptions and warnings on stderr, unless quiet.
Recording open_and_note(const RecordingOptions& options, const CommonOptions& common);

}  // namespace inlay
