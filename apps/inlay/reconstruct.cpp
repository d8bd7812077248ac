// `inlay reconstruct`: where the camera was in every frame, and the room as a mesh.
#include "composite/write/atomic_file.h"
#include "composite/write/frame_report.h"
#include "recordings/base/check.h"
#include "recordings/readers/trajectory.h"
#include "slam/mapping/advance_slam.h"
#include "slam/mesh/extract_mesh.h"
#include "slam/mesh/write_ply.h"

#include "apps/inlay/command.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/options.h"
#include "apps/inlay/progress.h"
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReconstructOptions {
    CommonOptions common;
    RecordingOptions recording;
    std::string out;
    std::string slam = "accurate";
};

/// What became of the chosen frames.
struct Reconstruction {
    Trajectory trajectory;
    std::string status_lines;
    int tracked = 0, weak = 0, lost = 0;
    TriangleMesh mesh;
    bool interrupted = false;
};

/// A lost frame has a status but no pose: one that was never found is not data.
void note(Reconstruction& result, const RgbdFrame& frame, const TrackResult& tracking) {
    const bool lost = tracking.status == TrackingStatus::lost;
    const auto time_ns = std::int64_t(std::llround(frame.time * 1e9));
    if (!lost) result.trajectory.poses.push_back({time_ns, {tracking.world_from_camera, ""}});
    const Json line{{"frame", frame.index},
                    {"time_s", frame.time},
                    {"status", name_of(tracking.status)},
                    {"in_poses_txt", !lost},
                    {"inlier_share", tracking.inlier_share},
                    {"rms_residual_m", tracking.rms_residual}};
    result.status_lines += line.dump() + "\n";
    result.tracked += tracking.status == TrackingStatus::tracked;
    result.weak += tracking.status == TrackingStatus::weak;
    result.lost += lost;
}

/// Tracks from the recording's first frame to the last chosen one, and notes the chosen ones.
Reconstruction reconstruct(const Recording& recording, const FrameList& chosen,
                           const SlamSettings& settings, bool quiet) {
    const int last = select_frames(chosen, recording.info.frames).back();
    int count = 0;
    for (const int number : recording.info.frames)
        count += number <= last;
    Progress progress("reconstructing", count, quiet);
    Reconstruction result;
    SlamState state = start_slam(settings);
    for (int done = 0; done < count && !result.interrupted; ++done) {
        const RgbdFrame frame = recording.load(recording.info.frames[std::size_t(done)]);
        const SlamStep step = advance_slam(state, frame, settings, std::nullopt);
        if (chosen.contains(frame.index)) note(result, frame, step.tracking);
        progress.advance_to(done + 1);
        result.interrupted = interrupted();
    }
    result.mesh = extract_mesh(state.volume);
    return result;
}

void write_all(const fs::path& folder, const Reconstruction& result) {
    write_tum_trajectory(folder / "poses.txt", result.trajectory);
    write_text(folder / "status.jsonl", result.status_lines);
    write_ply(folder / "mesh.ply", result.mesh);
}

void report(const ReconstructOptions& options, const Reconstruction& result) {
    if (options.common.json) {
        const Json json{{"out", options.out},
                        {"tracked", result.tracked},
                        {"weak", result.weak},
                        {"lost", result.lost},
                        {"vertices", result.mesh.positions.size()},
                        {"triangles", result.mesh.triangles.size()},
                        {"interrupted", result.interrupted}};
        std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
        return;
    }
    spdlog::info("{} frames tracked, {} weak, {} lost; {} triangles; {}", result.tracked,
                 result.weak, result.lost, result.mesh.triangles.size(), options.out);
}

int run(const ReconstructOptions& options) {
    apply(options.common);
    const FrameList chosen = parse_frames(options.common.frames);
    const Recording recording = open_and_note(options.recording, options.common);
    select_frames(chosen, recording.info.frames);
    make_folder(options.out);
    catch_interrupts();
    const SlamSettings settings = options.slam == "fast" ? fast_slam() : accurate_slam();
    const Reconstruction result = reconstruct(recording, chosen, settings, options.common.quiet);
    write_all(options.out, result);
    report(options, result);
    return int(result.interrupted ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace

std::function<int()> add_reconstruct(CLI::App& subcommand) {
    const auto options = std::make_shared<ReconstructOptions>();
    add_recording_options(subcommand, options->recording);
    add_common_options(subcommand, options->common);
    subcommand
        .add_option("--out", options->out,
                    "Folder for poses.txt (TUM form; lost frames have no line), status.jsonl (a "
                    "line for every frame) and mesh.ply")
        ->required();
    subcommand.add_option("--slam", options->slam, "Voxels and iterations: fast or accurate")
        ->check(CLI::IsMember({"fast", "accurate"}))
        ->capture_default_str();
    return [options] { return run(*options); };
}

}  // namespace inlay
