#include "apps/inlay/replay_output.h"

#include "composite/session/named_layers.h"
#include "composite/session/stop_watch.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"
#include "composite/write/write_video.h"
#include "recordings/base/check.h"
#include "recordings/readers/image_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <span>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

fs::path picture_file(const fs::path& folder, int frame) {
    return folder / "frames" / fmt::format("{:06d}.png", frame);
}

fs::path exr_file(const fs::path& folder, int frame) {
    return folder / "exr" / fmt::format("{:06d}.exr", frame);
}

/// FNV-1a.
std::string hash_of(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325ULL;
    for (const char c : text)
        hash = (hash ^ std::uint8_t(c)) * 0x100000001b3ULL;
    return fmt::format("{:016x}", hash);
}

/// Of what identifies a recording without decoding it.
std::string fingerprint(const RecordingInfo& info) {
    std::string text = info.profile;
    const Lens& l = info.lens;
    text += fmt::format(" {}x{} {} {} {} {} {} {} {} {} {} {}", l.width, l.height, l.fx, l.fy, l.cx,
                        l.cy, l.k1, l.k2, l.p1, l.p2, l.k3, info.units_per_metre);
    for (std::size_t i = 0; i < info.frames.size(); ++i)
        text += fmt::format(" {}:{}", info.frames[i], info.times[i]);
    return hash_of(text);
}

/// Of the scene file itself; meshes and textures that it names may change unnoticed.
std::string fingerprint(const fs::path& scene) {
    std::ifstream stream(scene, std::ios::binary);
    return hash_of({std::istreambuf_iterator<char>(stream), {}});
}

Json describe(const RecordingInfo& recording, const RunDescription& run) {
    Json settings, plan = Json::array();
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(run.settings);
    for (const PlannedEffect& e : run.plan.effects)
        plan.push_back({{"effect", e.name}, {"in", e.in}, {"reason", e.reason}});
    return {{"version", INLAY_VERSION},
            {"command", run.command},
            {"scene",
             {{"name", run.scene.filename().string()}, {"fingerprint", fingerprint(run.scene)}}},
            {"settings", settings},
            {"layers", run.layers},
            {"recording",
             {{"name", recording.path.filename().string()},
              {"profile", recording.profile},
              {"frames", recording.frames.size()},
              {"fingerprint", fingerprint(recording)}}},
            {"plan", plan}};
}

void require_same_run(const fs::path& file, const Json& now) {
    std::ifstream stream(file);
    const Json before = Json::parse(stream, nullptr, /*allow_exceptions=*/false);
    require(!before.is_discarded(),
            file.string() + ": not valid JSON, so the run cannot be resumed; choose another --out");
    for (const char* key : {"version", "scene", "settings", "layers", "recording"}) {
        require(before.contains(key) && before[key] == now[key],
                file.string() + ": this run was made with other " + key +
                    "; resume with the same ones, or choose another --out",
                ExitCode::usage);
    }
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
    if (finished.size() != reports.size()) write_file(file, std::as_bytes(std::span(lines)));
    return finished;
}

/// Pixels for which no real-geometry ray was traced.
std::uint64_t skipped_pixels(const OutputFrame& composed) {
    if (!composed.noisy) return composed.composite.linear.pixels.size();
    const NoisyLayers& noisy = *composed.noisy;
    std::uint64_t skipped = 0;
    for (std::size_t i = 0; i < noisy.m.pixels.size(); ++i)
        skipped += noisy.real.object.pixels[i] == 0 && noisy.virtual_.object.pixels[i] == 0;
    return skipped;
}

FrameReport report_of(const RgbdFrame& frame, const OutputFrame& composed) {
    FrameReport report;
    report.frame = frame.index;
    report.time = frame.time;
    report.tracking = composed.tracking.status;
    report.world_from_camera = composed.tracking.world_from_camera;
    report.ms = composed.ms;
    report.rays = composed.rays;
    report.pixels = {composed.composite.virtual_pixels, composed.composite.influenced_pixels,
                     skipped_pixels(composed)};
    report.plan = composed.plan.names();
    return report;
}

}  // namespace

ReplayOutput open_output(const fs::path& folder, const RecordingInfo& recording,
                         const RunDescription& run, bool resume) {
    make_folder(folder / "frames");
    make_folder(folder / "exr");
    ReplayOutput output{folder, run.layers, {}};
    const Json description = describe(recording, run);
    const fs::path run_file = folder / "run.json";
    if (fs::exists(run_file)) {
        require(
            resume,
            folder.string() + ": holds a run already; go on with --resume, or choose another --out",
            ExitCode::cannot_create);
        require_same_run(run_file, description);
        output.finished = finished_frames(folder);
    }
    const std::string text = description.dump(2) + "\n";
    write_file(run_file, std::as_bytes(std::span(text)));
    return output;
}

FrameReport write_frame(ReplayOutput& output, const RgbdFrame& frame, const OutputFrame& composed,
                        double load_ms) {
    StopWatch watch;
    const NamedLayers named = named_layers(composed, output.layers);
    ExrFile exr;
    exr.picture = &composed.composite.linear;
    exr.layers = named.layers;
    exr.frame = frame.index;
    exr.world_from_camera = composed.tracking.world_from_camera;
    write_exr(exr_file(output.folder, frame.index), exr);
    write_png(picture_file(output.folder, frame.index), composed.composite.display);
    FrameReport report = report_of(frame, composed);
    StageTimes& ms = report.ms;
    ms.load = load_ms;
    ms.write = watch.lap();
    ms.total = ms.load + ms.slam + ms.plan + ms.trace + ms.filter + ms.composite + ms.write;
    append_report(output.folder / "frames.jsonl", report);
    output.finished.insert(frame.index);
    return report;
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
