// `inlay replay`: the main job, a recording with virtual objects in it.
#include "composite/plan/explain.h"
#include "composite/session/known_recording.h"
#include "composite/session/named_layers.h"
#include "composite/session/prepare_scene.h"
#include "composite/session/stop_watch.h"
#include "recordings/base/check.h"
#include "slam/mapping/depth_scale.h"

#include "apps/inlay/command.h"
#include "apps/inlay/frame_list.h"
#include "apps/inlay/frame_selection.h"
#include "apps/inlay/governed_run.h"
#include "apps/inlay/interrupt.h"
#include "apps/inlay/invocation.h"
#include "apps/inlay/progress.h"
#include "apps/inlay/render_options.h"
#include "apps/inlay/replay_output.h"
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

namespace inlay {
namespace {

struct ReplayOptions {
    CommonOptions common;
    RecordingOptions recording;
    RenderOptions render;
    GovernOptions govern;
    std::string scene, out, video, shard;
    std::string slam;             // "" = by quality
    std::string poses, geometry;  // "" = by settings
    bool resume = false, explain = false;
};

/// What a run adds up to, for --json and the closing line.
struct Totals {
    int frames = 0, lost = 0;
    std::uint64_t pixels = 0, influenced = 0, dropped = 0, replaced = 0;
    StageTimes ms;  // sums

    void add(const FrameReport& report, const OutputFrame& out) {
        ++frames;
        lost += report.tracking == TrackingStatus::lost;
        pixels += out.composite.linear.pixels.size();
        influenced += report.pixels.influenced;
        dropped += report.dropped_samples;
        replaced += report.replaced_pixels;
        ms.load += report.ms.load;
        ms.slam += report.ms.slam;
        ms.plan += report.ms.plan;
        ms.trace += report.ms.trace;
        ms.filter += report.ms.filter;
        ms.composite += report.ms.composite;
        ms.write += report.ms.write;
        ms.total += report.ms.total;
    }
};

/// --set, which comes last, may still change what the other options chose.
Settings settings_of(const ReplayOptions& o) {
    Settings chosen;
    if (o.slam == "fast" || (o.slam.empty() && o.render.quality == "draft"))
        chosen.slam = fast_slam();
    if (!o.poses.empty()) apply_setting(chosen, "slam.poses=" + o.poses);
    if (!o.geometry.empty()) apply_setting(chosen, "geometry.kind=" + o.geometry);
    return settings_from(o.render, o.common, chosen);
}

/// Where the camera first stands; all that is known of its path before it is tracked.
std::optional<Pose> first_pose(const RecordingInfo& info, const Settings& settings) {
    if (!settings.use_recorded_poses) return info.world_from_camera.front().value_or(Pose{});
    for (const std::optional<Pose>& pose : info.world_from_camera)
        if (pose) return pose;
    return std::nullopt;
}

/// As the camera first stands and the scene is then, with a frame before it as all but the first
/// have.
EffectPlan plan_of(const Session& session, const RecordingInfo& info,
                   const SceneRequests& requests) {
    const std::optional<Pose> pose = first_pose(info, session.settings);
    const double first = info.times.front();
    const double next = info.times.size() > 1 ? info.times[1] : first;
    SlamStep view;
    if (session.known) view.gain = session.known->frames.front().gain;
    view.surface.lens = info.lens;
    view.tracking.world_from_camera = pose.value_or(Pose{});
    SceneFacts facts = gather_facts(in_frame(session, view, first, next));
    facts.tracked = pose.has_value();
    facts.first_frame = info.times.size() == 1;
    facts.light_kept = keeps_light(session);
    facts.requests = requests;
    return plan_effects(facts, session.settings.trace, session.settings.filter);
}

void print_totals(const ReplayOptions& o, const Totals& t) {
    const double unchanged = t.pixels > 0 ? 1 - double(t.influenced) / double(t.pixels) : 1.0;
    const double n = std::max(1, t.frames);
    if (o.common.json) {
        const nlohmann::ordered_json json{{"out", o.out},
                                          {"frames", t.frames},
                                          {"lost", t.lost},
                                          {"unchanged_share", unchanged},
                                          {"dropped_samples", t.dropped},
                                          {"replaced_pixels", t.replaced},
                                          {"mean_ms",
                                           {{"load", t.ms.load / n},
                                            {"slam", t.ms.slam / n},
                                            {"plan", t.ms.plan / n},
                                            {"trace", t.ms.trace / n},
                                            {"filter", t.ms.filter / n},
                                            {"composite", t.ms.composite / n},
                                            {"write", t.ms.write / n},
                                            {"total", t.ms.total / n}}}};
        std::cout << json.dump(2) << "\n";
        return;
    }
    spdlog::info(
        "{} frames in {}, {} with tracking lost; {:.1f} % of the pixels are the recorded "
        "ones; {:.0f} ms a frame (slam {:.0f}, trace {:.0f}, filter {:.0f})",
        t.frames, o.out, t.lost, 100 * unchanged, t.ms.total / n, t.ms.slam / n, t.ms.trace / n,
        t.ms.filter / n);
    warn_of_non_finite(t.dropped, t.replaced);
}

/// Composites what is not finished yet. Returns false if it was interrupted.
bool play(Session& session, const Recording& recording, const std::vector<int>& frames,
          ReplayOutput& output, GovernedRun& governed, const ReplayOptions& o, Totals& totals) {
    std::vector<int> open;
    for (const int frame : frames)
        if (!output.finished.contains(frame)) open.push_back(frame);
    const FilterSettings& filter = session.settings.filter;
    const bool temporal = filter.enabled && filter.temporal;
    std::vector<FrameTask> tasks = plan_frames(recording.info.frames, open, temporal);
    if (session.known)
        std::erase_if(tasks, [](const FrameTask& t) { return t.work == FrameWork::track; });
    Progress progress("frames", int(tasks.size()), o.common.quiet);
    for (std::size_t i = 0; i < tasks.size(); ++i) {
        if (interrupted()) return false;
        StopWatch watch;
        const RgbdFrame frame = recording.load(tasks[i].frame);
        const double load_ms = watch.lap();
        if (tasks[i].work != FrameWork::track) choose_samples(governed, session, frame.index);
        const OutputFrame out = advance(session, frame, tasks[i].work);
        if (out.tracking.status == TrackingStatus::lost && !session.settings.use_recorded_poses)
            spdlog::warn("frame {}: tracking is lost", frame.index);
        if (tasks[i].work == FrameWork::compose) {
            const auto choice = note_choice(governed, session, frame, out);
            const FrameReport report = write_frame(output, frame, out, {load_ms, choice});
            learn_from(governed, session, frame, out, report);
            totals.add(report, out);
        }
        progress.advance_to(int(i) + 1);
    }
    return true;
}

double rate_of(const RecordingInfo& info) {
    const double duration = info.times.back() - info.times.front();
    return duration > 0 ? double(info.times.size() - 1) / duration : 30.0;
}

/// Frames that are shown as they were recorded, since it is not known from where.
void warn_of_missing_poses(const RecordingInfo& info, const std::vector<int>& shown) {
    std::size_t missing = 0;
    for (std::size_t i = 0; i < info.frames.size(); ++i)
        missing += !info.world_from_camera[i] &&
                   std::binary_search(shown.begin(), shown.end(), info.frames[i]);
    if (missing > 0)
        spdlog::warn(
            "{} of {} frames have no usable recorded pose: they are lost, and the photograph alone "
            "is shown; leave out --poses recorded to track them",
            missing, shown.size());
}

RunDescription description_of(const ReplayOptions& o, const SceneFile& scene,
                              const Settings& settings, const EffectPlan& plan) {
    return {invocation(), o.common.frames, o.shard,  o.render.assets,
            o.scene,      scene.files,     settings, parse_layers(o.render.layers),
            plan,         o.govern.goal,   {}};
}

/// Adds what is known of the samples of frames: from the run that is asked for, and from the one
/// that is resumed, whose goal is kept.
void add_choices_before(const ReplayOptions& o, const RecordingInfo& recording,
                        RunDescription& run) {
    if (!o.govern.choices.empty()) {
        run.choices = read_governed(o.govern.choices, recording, run).choices;
        require(!run.choices.empty(), o.govern.choices +
                                          ": no samples of a frame were chosen there; "
                                          "expected the run.json of a run by time or by error");
    }
    const std::filesystem::path folder(o.out), file = folder / "run.json";
    if (!o.resume || !std::filesystem::exists(file)) return;
    const GovernedBefore before = read_governed(file, recording, run);
    const bool same_goal =
        before.goal.ms_per_frame == run.goal.ms_per_frame && before.goal.error == run.goal.error;
    require(same_goal,
            file.string() +
                ": this run was made with another --time-per-frame or "
                "--error; resume with the same, or choose another --out",
            ExitCode::usage);
    run.choices.insert(before.choices.begin(), before.choices.end());
    for (const FrameReport& report : read_reports(folder / "frames.jsonl"))
        if (report.governor) run.choices[report.frame] = report.governor->samples;
}

/// The recording, reconstructed if the settings look ahead; empty if that was interrupted.
std::optional<std::shared_ptr<const Reconstruction>> known_of(const Recording& recording,
                                                              const Settings& settings,
                                                              bool quiet) {
    if (!settings.slam.look_ahead) {
        if (settings.slam.check_scale) check_depth_scale(frames_of(recording));
        return nullptr;
    }
    Progress progress("reconstructing", passes_at_most * int(recording.info.frames.size()), quiet);
    int done = 0;
    auto known = know_recording(recording, settings, [&](int) {
        progress.advance_to(++done);
        return !interrupted();
    });
    if (!known->complete) return std::nullopt;
    return known;
}

/// Says what is odd about the scene.
Session session_of(const SceneFile& file, const Recording& recording, const Settings& settings,
                   std::shared_ptr<const Reconstruction> known) {
    PreparedScene prepared = prepare_scene(file, recording, settings, known.get());
    for (const std::string& warning : prepared.warnings)
        spdlog::warn("{}", warning);
    return start_session(settings, std::move(prepared.scene), std::move(prepared.environment),
                         std::move(known));
}

int run(const ReplayOptions& o) {
    apply(o.common);
    const Settings settings = settings_of(o);
    if (o.render.print_settings) {
        print_settings(settings);
        return 0;
    }
    validate(o.govern);
    require(!o.render.samples || !(o.govern.goal.ms_per_frame || o.govern.goal.error),
            "--samples: chosen by --time-per-frame or --error; leave out one of them",
            ExitCode::usage);
    require(!o.scene.empty(), "replay: --scene is missing: a scene file, as apps/demo/scene.json",
            ExitCode::usage);
    require(o.explain || !o.out.empty(), "replay: --out is missing: the folder to write",
            ExitCode::usage);
    parse_layers(o.render.layers);  // a wrong name is told before long work
    const Recording recording = open_and_note(o.recording, o.common);
    const std::vector<int> frames =
        shard_of(select_frames(parse_frames(o.common.frames), recording.info.frames), o.shard);
    const SceneFile file =
        load_scene_file(o.scene, {o.render.assets.begin(), o.render.assets.end()},
                        o.explain ? SceneUse::explain : SceneUse::simulate);
    if (settings.use_recorded_poses) warn_of_missing_poses(recording.info, frames);
    catch_interrupts();
    auto known = known_of(recording, settings, o.common.quiet);
    if (!known) return int(ExitCode::interrupted);
    Session session = session_of(file, recording, settings, std::move(*known));
    session.settings.skip &= o.render.layers.empty();  // whoever asks for layers wants all of them
    const EffectPlan plan = plan_of(session, recording.info, file.requests);
    if (o.explain) {
        std::cout << explain(plan);
        return 0;
    }
    RunDescription description = description_of(o, file, settings, plan);
    add_choices_before(o, recording.info, description);
    ReplayOutput output = open_output(o.out, recording.info, description, o.resume);
    GovernedRun governed = start_governed(settings.trace, o.govern.goal,
                                          price_key(recording.info, description, o.common.threads),
                                          description.choices);
    Totals totals;
    const bool finished = play(session, recording, frames, output, governed, o, totals);
    if (!governed.choices.empty()) {
        description.choices = governed.choices;
        write_run_file(o.out, recording.info, description);
    }
    if (!finished) {
        spdlog::warn("interrupted; finished frames stay, go on with --resume");
        return int(ExitCode::interrupted);
    }
    const std::string full = full_model_text(volume_of(session));
    if (!full.empty()) spdlog::warn("{}", full);
    if (!o.video.empty()) write_video(output, frames, o.video, rate_of(recording.info));
    if (o.render.report) write_report(output, recording, description);
    print_totals(o, totals);
    return 0;
}

}  // namespace

std::function<int()> add_replay(CLI::App& subcommand) {
    const auto o = std::make_shared<ReplayOptions>();
    add_recording_options(subcommand, o->recording);
    add_common_options(subcommand, o->common);
    add_render_options(subcommand, o->render);
    add_govern_options(subcommand, o->govern);
    subcommand.add_option("--scene", o->scene, "the scene file: objects and light");
    subcommand.add_option("--out", o->out, "the folder to write");
    subcommand
        .add_option(
            "--slam", o->slam,
            "fast: a model that grows from frame to frame; accurate: the "
            "whole recording is reconstructed first, once, and kept for later runs; draft quality "
            "is fast, the others accurate")
        ->check(CLI::IsMember({"fast", "accurate"}));
    subcommand
        .add_option("--poses", o->poses,
                    "tracked (default), or recorded: a frame without a usable recorded pose is "
                    "lost, and shows the photograph alone")
        ->check(CLI::IsMember(setting_words("slam.poses")));
    subcommand
        .add_option("--geometry", o->geometry,
                    "what rays meet of the real scene: screen|map|model: this frame's surface "
                    "map marched in the image, the same as triangles, or the fused model as "
                    "triangles (default)")
        ->check(CLI::IsMember(setting_words("geometry.kind")));
    subcommand.add_option("--video", o->video, "also make a video, as FILE.mp4");
    subcommand.add_option("--shard", o->shard, "I/N: only the I-th of N runs of frames");
    subcommand.add_flag("--resume", o->resume, "go on with the run that the folder holds");
    subcommand.add_flag("--explain", o->explain,
                        "print which effects are simulated and why, and stop");
    return [o] { return run(*o); };
}

}  // namespace inlay
