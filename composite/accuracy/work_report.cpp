#include "composite/accuracy/work_report.h"

#include "composite/accuracy/report_pictures.h"
#include "recordings/base/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace inlay {
namespace {

/// Root of the mean over frames of the squared standard errors.
double standard_error(const std::vector<JudgedFrame>& frames,
                      std::optional<Reference> JudgedFrame::*kind) {
    double sum = 0;
    int count = 0;
    for (const JudgedFrame& frame : frames) {
        if (!(frame.*kind)) continue;
        const double error = influenced_standard_error(*(frame.*kind));
        sum += error * error;
        ++count;
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

void warn_of_left_out(const Work& work, const std::vector<JudgedFrame>& frames,
                      const BenchWatcher& watcher) {
    const auto compared = compared_frames(frames);
    for (const JudgedFrame& frame : frames)
        if (std::find(compared.begin(), compared.end(), &frame) == compared.end())
            watcher.warn(
                fmt::format("{}: frame {} has no previous frame to filter with, others have, so no "
                            "cell is measured on it",
                            work.name, frame.now.frame));
    for (const JudgedFrame& frame : frames)
        if (frame.truth && frame.truth->left_out > 0)
            watcher.warn(
                fmt::format("{}: {} pixels of frame {}'s truth are not finite and are "
                            "left out",
                            work.name, frame.truth->left_out, frame.now.frame));
}

WorkReport figures_of_work(const Work& work, const WorkMeasurements& measured,
                           const BenchOptions& options) {
    WorkReport report;
    report.name = work.name;
    report.kind = work.recording ? "recording" : "scene";
    const std::vector<JudgedFrame>& frames = measured.frames;
    report.width = frames.front().now.lens.width;
    report.height = frames.front().now.lens.height;
    for (const JudgedFrame* frame : compared_frames(frames))
        report.frames.push_back(frame->now.frame);
    report.environment_bandwidth = work.environment_bandwidth;
    report.converged_samples = options.converged_samples;
    report.truth_samples = work.truth_samples;
    report.converged_standard_error = standard_error(frames, &JudgedFrame::converged);
    report.truth_standard_error = standard_error(frames, &JudgedFrame::truth);
    std::vector<UnitRun> own;
    for (const UnitRun& unit : measured.units)
        if (unit.work == work.name) own.push_back(unit);
    report.cells = cells_of(own);
    return report;
}

/// The stage to blame where the frame's table is known; "" where it is not.
std::string blamed(const WorkReport& report, int frame) {
    for (const FrameBlame& blame : report.blame)
        if (blame.frame == frame) return std::string("; blame ") + name_of(blame.culprit);
    return "";
}

/// What needs the truth of every stage: the stages to blame, and the frames' budgets.
void add_verdicts(const Work& work, const JudgedFrame& frame, const BenchOptions& options,
                  const BenchWatcher& watcher, WorkReport& report) {
    const int samples = std::max(1, options.converged_samples / 2);
    report.blame.push_back(blame_frame(work, frame.now.frame, options.settings, samples));
    const auto verdict = judge_frame(work, frame.now, options.settings, samples);
    if (!verdict) return;  // nothing virtual is in view
    report.verdicts.push_back(*verdict);
    if (!keeps_budget(*verdict))
        watcher.warn(fmt::format("{}, {}{}", work.name, verdict_line(*verdict),
                                 blamed(report, frame.now.frame)));
}

}  // namespace

WorkReport report_work(const Work& work, const WorkMeasurements& measured,
                       const BenchOptions& options, const std::filesystem::path& folder,
                       const BenchWatcher& watcher) {
    warn_of_left_out(work, measured.frames, watcher);
    WorkReport report = figures_of_work(work, measured, options);
    report.pictures = report_pictures(work, *compared_frames(measured.frames).front(), report.cells,
                                      options.settings, folder);
    if (!options.blame) return report;
    report.estimate = check_estimate(work, measured.frames, options.settings);
    const SamplingSettings& trace = options.settings.trace;
    if (trace.primary * trace.secondary < 2)
        watcher.warn(work.name +
                     ": one sample per pixel has no half, so the error is not estimated without "
                     "truth");
    if (!work.recording || !work.knows_room) return report;
    for (const JudgedFrame& frame : measured.frames) {
        if (watcher.interrupted())
            throw Error(ExitCode::interrupted,
                        "accuracy: interrupted; what was measured stays, go on with --resume");
        if (frame.truth) add_verdicts(work, frame, options, watcher, report);
    }
    return report;
}

}  // namespace inlay
