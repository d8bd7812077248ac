// Knobs: which settings the bench varies, one row each.
#pragma once

#include "composite/accuracy/tracked_frame.h"
#include "composite/session/settings.h"

#include <functional>
#include <string>
#include <vector>

namespace inlay {

/// How one column of the matrix is sampled. What starts with slam. or geometry. needs a
/// reconstruction of its own.
struct Sampling {
    Settings settings;
    SensorDepth depth = SensorDepth::recorded;
    int light_list =
        0;  // directions in a list of the environment's light; 0: drawn from its tables
};

struct Knob {
    std::string name;                 // as in accuracy.json
    std::vector<std::string> values;  // the first is the program's default where there is one
    std::function<void(Sampling&, const std::string& value)> turn;
    bool all_methods = false;     // else only the default filter is measured
    bool needs_room = false;      // only works that know their real objects
    bool needs_tracking = false;  // only recordings
    bool against_truth = false;   // it moves the geometry, so that only truth can judge
};

/// All knobs; `quick` keeps few values of few of them.
std::vector<Knob> knobs(bool quick);

}  // namespace inlay
