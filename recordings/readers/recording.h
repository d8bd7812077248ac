// Recording: what a folder of RGB-D frames holds, and how its frames are loaded.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/rgbd_frame.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// What is known of a recording without decoding a pixel. `frames`, `times` and
/// `world_from_camera` run in parallel.
struct RecordingInfo {
    std::filesystem::path path;
    std::string profile;             // the reader's name
    std::vector<int> frames;         // the recording's own numbers, ascending
    std::vector<double> times;       // s since the first frame
    std::int64_t first_time_ns = 0;  // of the first frame, by the files' clock if any
    std::vector<std::optional<Pose>> world_from_camera;  // as recorded
    bool synthetic_times = false;                        // the files carry none: 30 a second
    Lens lens;                                           // of both images
    double units_per_metre = 1000;                       // of the stored depth
    float max_depth = 0;                                 // m, farther is dropped; 0 = no limit
    std::optional<glm::dvec3> up;                        // unit, in the world of the poses
    std::string pose_source = "none";                    // which file, in which sense
    int unusable_poses = 0;                              // present in the files, but refused
    std::vector<std::string> assumptions;                // what the files do not say
    std::vector<std::string> warnings;                   // what is wrong with them
};

struct Recording {
    RecordingInfo info;
    /// Decodes the frame with this number; may be called from several threads. Throws Error
    /// (bad_data, input_missing) that names the file.
    std::function<RgbdFrame(int number)> load;
};

/// What the caller knows better than the files; everything empty takes what is found.
struct OpenOptions {
    std::optional<std::string> profile;               // a reader's name
    std::optional<double> depth_scale;                // units per metre, > 0
    std::optional<glm::dvec4> lens;                   // fx, fy, cx, cy (px)
    std::optional<std::array<double, 5>> distortion;  // k1, k2, p1, p2, k3
    std::optional<float> max_depth;                   // m, > 0; 0 = no limit
};

/// Finds a reader for the folder (or takes that of `options.profile`), reads its lists, poses and
/// the first frame's headers. Throws Error: usage for impossible options, input_missing for a
/// missing folder, bad_data with file and line for damaged lists and for a folder no reader knows.
Recording open_recording(const std::filesystem::path& folder, const OpenOptions& options = {});

/// The names that `OpenOptions::profile` may take.
std::vector<std::string> reader_names();

}  // namespace inlay
