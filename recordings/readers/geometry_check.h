// Geometry check: does depth, carried from one frame into another by the recorded poses, meet the
// depth measured there? A wrong guess of scale, pose direction or lens shows.
#pragma once

#include "recordings/readers/recording.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

struct GeometryCheckSettings {
    int pairs = 20;                // of frames, spread over the recording
    int max_step = 64;             // frames between the two of a pair
    double max_rotation = 0.35;    // rad between them, so that they overlap
    double max_translation = 0.5;  // m between them
    int grid = 8;                  // px between the samples of a frame
};

/// How well one reading of the recording agrees with itself.
struct GeometryResidual {
    std::string name;     // "as opened", "depth scale 5000", "poses inverted", ...
    double metres = 0;    // median |z carried over - z measured|
    double relative = 0;  // median of the same over z measured
    int samples = 0;
};

struct GeometryCheck {
    int pairs = 0;                           // that could be loaded; 0: nothing was checked
    double baseline = 0;                     // m, median distance between the cameras of a pair
    std::vector<GeometryResidual> results;   // the first is the recording as opened
    std::optional<GeometryResidual> better;  // an alternative that agrees clearly better, if any
};

/// Compares the recording as opened with other depth scales (1000, 5000, 6553.5 units per m),
/// inverted poses, ignored poses, the other sign of fy, and the lens without its distortion.
/// Alternatives are ranked by the relative residual, since a wrong scale shrinks the other; one is
/// `better` when its residual is below 0.8 of the chosen one's, by 0.1 % of z at least, on a
/// quarter of the samples or more. Frames that cannot be decoded are skipped. Recordings with
/// fewer than two usable poses give pairs = 0.
GeometryCheck check_geometry(const Recording& recording,
                             const GeometryCheckSettings& settings = {});

}  // namespace inlay
