// A replay whose samples are chosen frame by frame: by a governor, or as one chose before.
#pragma once

#include "composite/govern/governor.h"
#include "composite/session/session.h"
#include "composite/write/frame_report.h"

#include <CLI/App.hpp>

#include <map>
#include <optional>
#include <string>

namespace inlay {

struct GovernOptions {
    Goal goal;            // neither: none
    std::string choices;  // a run.json whose choices are made again; "" = none
};

/// The options refer to `options`, which must outlive the parsing.
void add_govern_options(CLI::App& subcommand, GovernOptions& options);

/// Throws Error (usage) where the options contradict each other or are out of range.
void validate(const GovernOptions& options);

struct GovernedRun {
    SamplingSettings base;             // what a choice changes the samples of
    Goal goal;                         // neither: only the choices are followed
    std::string price_key;             // of the front that the goal is reached by
    std::map<int, int> choices;        // of each frame so far, or of each frame of a run before
    std::optional<Governor> governor;  // once there is a front
    std::optional<Choice> now;         // of the frame at hand, if the governor made it
    bool extracts = false;             // the frame at hand extracts the model
    int until_check = 0;               // frames until the error is estimated again
};

/// A run that follows `choices`, and chooses where they say nothing if there is a goal: by the
/// prices kept under `price_key`, or else by those of the first frame that shows virtual objects.
GovernedRun start_governed(const SamplingSettings& base, const Goal& goal, std::string price_key,
                           std::map<int, int> choices);

/// Sets the samples of the frame, which is next. Throws Error (usage) where they are neither known
/// nor to be chosen.
void choose_samples(GovernedRun& run, Session& session, int frame);

/// What the frame's line says of its samples. Estimates the frame's error where that is due.
std::optional<GovernedFrame> note_choice(GovernedRun& run, Session& session, const RgbdFrame& frame,
                                         const OutputFrame& out);

/// Makes the next choice by what the frame took, writing included. Measures the prices where there
/// are none.
void learn_from(GovernedRun& run, Session& session, const RgbdFrame& frame, const OutputFrame& out,
                const FrameReport& report);

}  // namespace inlay
