// Unit: one setting of one knob on one work, measured once: what a run finishes and keeps at a
// time.
#pragma once

#include "composite/accuracy/cost.h"
#include "composite/accuracy/knobs.h"
#include "composite/accuracy/methods.h"
#include "composite/accuracy/reference.h"
#include "render/trace/ray_counts.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// A frame with the one before it and with what judges it.
struct JudgedFrame {
    TrackedFrame now;
    std::optional<TrackedFrame> previous;  // none: the first, or objects moved in between
    std::optional<Reference> converged, truth;
};

/// A method at one of its widths, with or without the previous frame.
struct MethodCell {
    const Method* method = nullptr;
    bool temporal = false;
    double width = 0;
};

/// What one method made of one frame.
struct MethodRun {
    std::string method;
    bool temporal = false;
    double width = 0;
    int frame = 0;
    Cost filter, composite;
    std::optional<Cost> trace;      // of samples of its own; none: the frame's
    std::optional<RayCounts> rays;  // the same
    std::optional<FrameError> converged, truth;
    std::optional<double> flicker;  // RMS change of a still camera's picture, relative radiance
    std::string failed;             // empty: it did not
};

struct FrameRun {
    int frame = 0;
    double slam_ms = 0;
    Cost trace;  // of the samples that both modes share; 0 where no method takes them
    RayCounts rays;
};

struct UnitRun {
    std::string work, knob, value;
    int repeat = 0;
    int primary = 0, secondary = 0;
    double peak_mb = 0;  // of the process, so far
    std::vector<FrameRun> frames;
    std::vector<MethodRun> runs;
};

struct UnitPlan {
    std::string knob, value;
    Settings settings;
    std::vector<MethodCell> cells;
    bool judge = true;          // else only times are taken
    bool with_flicker = false;  // two more samplings of each frame
    int light_list = 0;         // see Sampling
};

/// The frames that all cells are measured on, so that those with and without the previous frame
/// average over the same: the ones that have a previous frame, or all where none has.
std::vector<const JudgedFrame*> compared_frames(const std::vector<JudgedFrame>& frames);

/// Samples every compared frame once and hands the samples to every method in turn. A method that
/// throws is reported in its run; the others go on.
UnitRun measure_unit(const Work& work, const std::vector<JudgedFrame>& frames,
                     const UnitPlan& plan);

/// A frame's samples with the cost of taking them. `index` is part of the random numbers' key.
struct SampledFrame {
    TwoModeResult result;
    Cost cost;
};
SampledFrame sample_frame(const Work& work, const TrackedFrame& frame,
                          const SamplingSettings& sampling, std::uint32_t index);

/// Settings for `samples` per pixel and their `converged` references: camera rays for edges and
/// textures as well as for light, and no virtual surface favoured.
SamplingSettings many_samples(SamplingSettings sampling, int samples);

/// One of the two halves, 0 or 1, of a reference: unfiltered light from `samples` per pixel, of a
/// seed that no measurement has.
Layers converged_half(const Work& work, const TrackedFrame& frame, const Settings& settings,
                      int samples, std::uint32_t half);

/// The picture of the two-mode sampler without noise or filter: the mean of its two halves.
Reference converge(const Work& work, const TrackedFrame& frame, const Settings& settings,
                   int samples_per_half);

}  // namespace inlay
