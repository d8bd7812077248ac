// `inlay reconstruct`: where the camera was in every frame, and the room as a mesh.
#include "composite/session/known_recording.h"
#include "composite/session/reconstruction_json.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"
#include "recordings/readers/trajectory.h"
#include "slam/mesh/extract_mesh.h"
#include "slam/mesh/write_ply.h"

#include "apps/inlay/command.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/options.h"
#include "apps/inlay/progress.h"
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct ReconstructOptions {
    CommonOptions common;
    RecordingOptions recording;
    std::string out;
    std::string slam = "accurate";
    bool registers = true;
};

/// What became of the chosen frames.
struct Chosen {
    Trajectory trajectory;
    std::string status_lines;
    int tracked = 0, weak = 0, lost = 0;
    std::size_t vertices = 0, triangles = 0;
    std::optional<ColorRegistration> registration;
    std::string unreadable;  // what is wrong with the first frame that cannot be read
    bool interrupted = false;
};

/// A lost frame has a pose too, the last one known, so that the file has a line for each frame.
void note(Chosen& chosen, const ReconstructedFrame& frame, std::int64_t first_time_ns) {
    const auto time_ns = first_time_ns + std::int64_t(std::llround(frame.time * 1e9));
    chosen.trajectory.poses.push_back({time_ns, {frame.tracking.world_from_camera, ""}});
    if (!frame.readable && chosen.unreadable.empty()) chosen.unreadable = frame.tracking.why;
    chosen.status_lines += status_json(frame).dump() + "\n";
    chosen.tracked += frame.tracking.status == TrackingStatus::tracked;
    chosen.weak += frame.tracking.status == TrackingStatus::weak;
    chosen.lost += frame.tracking.status == TrackingStatus::lost;
}

/// The whole recording; without a look ahead only up to the last chosen frame, since later ones
/// change nothing.
std::shared_ptr<const Reconstruction> reconstruct(const Recording& recording,
                                                  const FrameList& frames, const Settings& settings,
                                                  bool quiet) {
    FrameSource source = frames_of(recording);
    const int last = select_frames(frames, recording.info.frames).back();
    if (!settings.slam.look_ahead) {
        const auto end = std::upper_bound(source.numbers.begin(), source.numbers.end(), last);
        source.numbers.erase(end, source.numbers.end());
    }
    const int passes = settings.slam.look_ahead ? passes_at_most : 1;
    Progress progress("reconstructing", passes * source.count(), quiet);
    int done = 0;
    const auto go_on = [&](int) {
        progress.advance_to(++done);
        return !interrupted();
    };
    if (settings.slam.look_ahead) return know_recording(recording, settings, go_on);
    return std::make_shared<const Reconstruction>(
        reconstruct_recording(source, settings.slam, PoseSource::tracked, go_on));
}

Chosen write_all(const fs::path& folder, const Reconstruction& result, const FrameList& frames,
                 std::int64_t first_time_ns) {
    Chosen chosen;
    for (const ReconstructedFrame& frame : result.frames)
        if (frames.contains(frame.number)) note(chosen, frame, first_time_ns);
    const TriangleMesh mesh = extract_mesh(result.volume);
    chosen.vertices = mesh.positions.size();
    chosen.triangles = mesh.triangles.size();
    chosen.interrupted = !result.complete;
    chosen.registration = result.registration;
    if (const std::string full = full_model_text(result.volume); !full.empty())
        spdlog::warn("{}", full);
    write_tum_trajectory(folder / "poses.txt", chosen.trajectory);
    write_text(folder / "status.jsonl", chosen.status_lines);
    write_text(folder / "keyframes.json", keyframes_json(result).dump(2) + "\n");
    if (result.registration)
        write_text(folder / "registration.json",
                   registration_json(*result.registration).dump(2) + "\n");
    write_ply(folder / "mesh.ply", mesh);
    return chosen;
}

void report(const ColorRegistration& r) {
    if (r.points == 0) {
        spdlog::warn(
            "too few or too small images to tell how color and depth lie to each other: "
            "taken as registered");
        return;
    }
    const glm::dvec3& t = r.color_from_depth.translation;
    spdlog::info(
        "color camera: {}; t = ({:.1f}, {:.1f}, {:.1f}) mm, turned by {:.2f} degrees, f = {:.1f} "
        "px, "
        "{:.1f} ms later ({}); depth edges {:.2f} px from color edges before, {:.2f} px after",
        r.needed ? "apart from the depth camera" : "registered to depth as recorded", 1e3 * t.x,
        1e3 * t.y, 1e3 * t.z, glm::degrees(rotation_angle(Pose{}, r.color_from_depth)),
        r.color_lens.fx, 1e3 * r.delay, r.delay_needed ? "heeded" : "not told from 0",
        r.distance_before, r.distance_after);
}

void report(const ReconstructOptions& options, const Chosen& result) {
    if (options.common.json) {
        const Json json{{"out", options.out},
                        {"tracked", result.tracked},
                        {"weak", result.weak},
                        {"lost", result.lost},
                        {"vertices", result.vertices},
                        {"triangles", result.triangles},
                        {"interrupted", result.interrupted}};
        std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
        return;
    }
    if (result.registration) report(*result.registration);
    spdlog::info("{} frames tracked, {} weak, {} lost; {} triangles; {}", result.tracked,
                 result.weak, result.lost, result.triangles, options.out);
}

int run(const ReconstructOptions& options) {
    apply(options.common);
    const FrameList chosen = parse_frames(options.common.frames);
    const Recording recording = open_and_note(options.recording, options.common);
    select_frames(chosen, recording.info.frames);
    make_folder(options.out);
    catch_interrupts();
    Settings settings;
    if (options.slam == "fast") settings.slam = fast_slam();
    settings.slam.register_color = options.registers;
    const Chosen result =
        write_all(options.out, *reconstruct(recording, chosen, settings, options.common.quiet),
                  chosen, recording.info.first_time_ns);
    report(options, result);
    require(result.unreadable.empty(), result.unreadable);
    return int(result.interrupted ? ExitCode::interrupted : ExitCode::done);
}

}  // namespace

std::function<int()> add_reconstruct(CLI::App& subcommand) {
    const auto options = std::make_shared<ReconstructOptions>();
    add_recording_options(subcommand, options->recording);
    add_common_options(subcommand, options->common);
    subcommand
        .add_option(
            "--out", options->out,
            "Folder for poses.txt (TUM form, a line for every frame; a lost one has the last "
            "pose known), status.jsonl (likewise: status, and why), keyframes.json and "
            "mesh.ply")
        ->required();
    subcommand
        .add_option(
            "--slam", options->slam,
            "fast: one pass at half resolution; accurate: looks ahead, closes loops, tracks twice")
        ->check(CLI::IsMember({"fast", "accurate"}))
        ->capture_default_str();
    subcommand.add_flag("--register,!--no-register", options->registers,
                        "find out how the color images lie to the depth images, and use it where "
                        "they are not registered (with --slam accurate; on by default)");
    return [options] { return run(*options); };
}

}  // namespace inlay
