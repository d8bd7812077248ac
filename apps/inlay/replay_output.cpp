#include "apps/inlay/replay_output.h"

#include "composite/session/named_layers.h"
#include "composite/session/stop_watch.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"
#include "composite/write/write_video.h"
#include "recordings/base/check.h"
#include "recordings/readers/image_files.h"

#include "apps/inlay/run_page.h"
#include <fmt/format.h>

#include <algorithm>

namespace inlay {
namespace {

namespace fs = std::filesystem;

fs::path picture_file(const fs::path& folder, int frame) {
    return folder / "frames" / fmt::format("{:06d}.png", frame);
}

fs::path exr_file(const fs::path& folder, int frame) {
    return folder / "exr" / fmt::format("{:06d}.exr", frame);
}

/// Frames with a line and both files. Lines of other frames, which are made again, are removed.
std::set<int> finished_frames(const fs::path& folder) {
    const fs::path file = folder / "frames.jsonl";
    const std::vector<FrameReport> reports = read_reports(file);
    std::set<int> finished;
    std::string lines;
    for (const FrameReport& report : reports) {
        if (!fs::exists(picture_file(folder, report.frame)) ||
            !fs::exists(exr_file(folder, report.frame)))
            continue;
        finished.insert(report.frame);
        lines += to_json_line(report) + "\n";
    }
    if (finished.size() != reports.size()) write_text(file, lines);
    return finished;
}

/// Pixels for which no real-geometry ray was traced.
std::uint64_t skipped_pixels(const OutputFrame& composed) {
    if (!composed.noisy) return composed.composite.linear.pixels.size();
    const NoisyLayers& noisy = *composed.noisy;
    std::uint64_t skipped = 0;
    for (std::size_t i = 0; i < noisy.m.pixels.size(); ++i)
        skipped += (noisy.real.object.pixels[i] == 0 ||
                    (!noisy.sampled_real.empty() && noisy.sampled_real.pixels[i] == 0)) &&
                   (noisy.virtual_.object.empty() || noisy.virtual_.object.pixels[i] == 0);
    return skipped;
}

/// The first, the middle and the last of frames in ascending order.
std::set<int> shown_frames(const std::vector<FrameReport>& reports) {
    if (reports.empty()) return {};
    return {reports.front().frame, reports[reports.size() / 2].frame, reports.back().frame};
}

}  // namespace

FrameReport report_of(int frame, double time, const OutputFrame& composed) {
    FrameReport report;
    report.frame = frame;
    report.time = time;
    report.tracking = composed.tracking.status;
    report.world_from_camera = composed.tracking.world_from_camera;
    report.exposure = composed.exposure;
    report.ms = composed.ms;
    report.rays = composed.rays;
    report.pixels = {composed.composite.virtual_pixels, composed.composite.influenced_pixels,
                     skipped_pixels(composed)};
    report.dropped_samples = composed.dropped_samples;
    report.replaced_pixels = composed.composite.replaced_pixels;
    report.plan = composed.plan.names();
    return report;
}

ReplayOutput open_output(const fs::path& folder, const RecordingInfo& recording,
                         const RunDescription& run, bool resume) {
    make_folder(folder / "frames");
    make_folder(folder / "exr");
    ReplayOutput output{folder, run.layers, {}};
    const bool begun = fs::exists(folder / "run.json");
    require(resume || !begun,
            folder.string() + ": holds a run already; go on with --resume, or choose another --out",
            ExitCode::cannot_create);
    write_run_file(folder, recording, run);
    if (begun) output.finished = finished_frames(folder);
    return output;
}

FrameReport write_frame(ReplayOutput& output, const RgbdFrame& frame, const OutputFrame& composed,
                        const FrameNotes& notes) {
    StopWatch watch;
    const NamedLayers named = named_layers(composed, output.layers);
    ExrFile exr;
    exr.picture = &composed.composite.linear;
    exr.layers = named.layers;
    exr.frame = frame.index;
    exr.world_from_camera = composed.tracking.world_from_camera;
    exr.exposure = composed.exposure;
    write_exr(exr_file(output.folder, frame.index), exr);
    write_png(picture_file(output.folder, frame.index), composed.composite.display);
    FrameReport report = report_of(frame.index, frame.time, composed);
    StageTimes& ms = report.ms;
    report.governor = notes.governor;
    ms.load = notes.load_ms;
    ms.write = watch.lap();
    ms.total = ms.load + ms.slam + ms.plan + ms.trace + ms.filter + ms.composite + ms.write;
    append_report(output.folder / "frames.jsonl", report);
    output.finished.insert(frame.index);
    return report;
}

void write_report(const ReplayOutput& output, const Recording& recording,
                  const RunDescription& run) {
    RunPage page{name_of(recording.info),
                 run.scene.filename().string(),
                 run.settings,
                 run.plan,
                 read_reports(output.folder / "frames.jsonl"),
                 {}};
    std::sort(page.frames.begin(), page.frames.end(),
              [](const FrameReport& a, const FrameReport& b) { return a.frame < b.frame; });
    for (const int frame : shown_frames(page.frames))
        page.pictures.push_back(
            {frame, recording.load(frame).color, read_color(picture_file(output.folder, frame))});
    write_run_page(output.folder / "report.html", page);
}

void write_video(const ReplayOutput& output, const std::vector<int>& frames, const fs::path& file,
                 double frames_per_second) {
    if (frames.empty()) return;
    const Image<EncodedRgb> first = read_color(picture_file(output.folder, frames.front()));
    VideoSettings settings;
    settings.frames_per_second = frames_per_second;
    VideoWriter video(file, first.width, first.height, settings);
    for (const int frame : frames)
        video.write(read_color(picture_file(output.folder, frame)));
    video.close();
}

}  // namespace inlay
