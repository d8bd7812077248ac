// What `inlay info` measures in a recording.
#pragma once

#include "recordings/readers/geometry_check.h"
#include "recordings/readers/recording.h"

#include <string>
#include <vector>

namespace inlay {

/// Of the measured pixels of a few sampled frames.
struct DepthFigures {
    int frames = 0;                        // sampled
    double coverage = 0;                   // share of the pixels that are measured
    double near = 0, median = 0, far = 0;  // m: 1, 50 and 99 %
};

struct TimeGap {
    int after_frame = 0;
    double seconds = 0;
};

struct TimeFigures {
    double duration = 0, median_step = 0;  // s
    std::vector<TimeGap> gaps;             // steps of more than 1.5 medians, widest first
};

struct InfoFigures {
    DepthFigures depth;
    TimeFigures time;
    GeometryCheck geometry;
    std::vector<std::string> warnings;  // sampled frames that cannot be decoded
};

/// Measures depth on a dozen of the given frames, and time and geometry on the whole recording.
InfoFigures measure_recording(const Recording& recording, const std::vector<int>& frames);

/// Frames that have a usable recorded pose.
int poses_in(const RecordingInfo& info);

}  // namespace inlay
