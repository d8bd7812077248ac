// `inlay info`: what a recording holds, what was assumed, and what is wrong with it.
#include "apps/inlay/command.h"
#include "apps/inlay/info_figures.h"
#include "apps/inlay/info_trajectory.h"
#include "apps/inlay/options.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <iostream>
#include <memory>

namespace inlay {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    CommonOptions common;
    RecordingOptions recording;
    std::vector<std::string> trajectories;  // two, or none
};

std::string lens_text(const Lens& lens) {
    std::string text =
        fmt::format("fx {:g} fy {:g} cx {:g} cy {:g} px, ", lens.fx, lens.fy, lens.cx, lens.cy);
    if (!distorted(lens)) return text + "no distortion";
    return text + fmt::format("distortion {:g} {:g} {:g} {:g} {:g}", lens.k1, lens.k2, lens.p1,
                              lens.p2, lens.k3);
}

std::string depth_text(const RecordingInfo& info, const DepthFigures& depth) {
    std::string text = fmt::format("{:g} units per m", info.units_per_metre);
    if (info.max_depth > 0) text += fmt::format(", cut at {:g} m", info.max_depth);
    if (depth.coverage <= 0) return text + "; nothing is measured";
    return text + fmt::format(
                      "; {:.2f} to {:.2f} m (1 to 99 %), median {:.2f} m; {:.1f} % of the "
                      "pixels measured, in {} sampled frames",
                      depth.near, depth.far, depth.median, 100 * depth.coverage, depth.frames);
}

std::string time_text(const RecordingInfo& info, const TimeFigures& time) {
    std::string text =
        fmt::format("{:.3f} s, median step {:.1f} ms", time.duration, 1000 * time.median_step);
    if (info.synthetic_times) text += " (synthetic)";
    if (time.gaps.empty()) return text + ", no gaps";
    text += fmt::format(", {} gaps:", time.gaps.size());
    for (std::size_t i = 0; i < time.gaps.size() && i < 5; ++i)
        text += fmt::format(" {:.0f} ms after frame {}{}", 1000 * time.gaps[i].seconds,
                            time.gaps[i].after_frame, i + 1 < time.gaps.size() ? "," : "");
    return text + (time.gaps.size() > 5 ? " ..." : "");
}

std::string poses_text(const RecordingInfo& info) {
    if (info.pose_source == "none") return "none recorded";
    return fmt::format("{} of {} frames, from {}", poses_in(info), info.frames.size(),
                       info.pose_source);
}

void print_line(const char* name, const std::string& text) {
    std::cout << fmt::format("  {:<10}{}\n", name, text);
}

void print_geometry(const GeometryCheck& check) {
    if (check.pairs == 0) return print_line("geometry", "not checked: it takes two recorded poses");
    print_line("geometry", fmt::format("depth carried between {} frame pairs by the poses "
                                       "(median baseline {:.3f} m) is off by:",
                                       check.pairs, check.baseline));
    for (const GeometryResidual& r : check.results) {
        const bool better = check.better && check.better->name == r.name;
        std::cout << fmt::format("    {:<26}{:8.1f} mm {:7.2f} % of z {:8} samples{}\n", r.name,
                                 1000 * r.metres, 100 * r.relative, r.samples,
                                 better ? "   <-- better than as opened" : "");
    }
    if (check.better)
        print_line("warning", "'" + check.better->name +
                                  "' agrees better with the depth than the recording as opened: "
                                  "check --depth-scale, --lens and the poses");
}

void print_text(const RecordingInfo& info, const InfoFigures& figures) {
    std::cout << fmt::format("{}: {} recording, {} frames ({} to {}), {} x {} px\n",
                             info.path.string(), info.profile, info.frames.size(),
                             info.frames.front(), info.frames.back(), info.lens.width,
                             info.lens.height);
    print_line("lens", lens_text(info.lens));
    print_line("depth", depth_text(info, figures.depth));
    print_line("time", time_text(info, figures.time));
    print_line("poses", poses_text(info));
    print_line("up", info.up ? fmt::format("{:.4f} {:.4f} {:.4f} in the world of the poses",
                                           info.up->x, info.up->y, info.up->z)
                             : "unknown");
    for (const std::string& assumption : info.assumptions)
        print_line("assumed", assumption);
    for (const std::string& warning : info.warnings)
        print_line("warning", warning);
    for (const std::string& warning : figures.warnings)
        print_line("warning", warning);
    print_geometry(figures.geometry);
}

Json geometry_json(const GeometryCheck& check) {
    Json rows = Json::array();
    for (const GeometryResidual& r : check.results)
        rows.push_back({{"reading", r.name},
                        {"residual_m", r.metres},
                        {"residual_relative", r.relative},
                        {"samples", r.samples}});
    return {{"pairs", check.pairs},
            {"baseline_m", check.baseline},
            {"readings", rows},
            {"better", check.better ? Json(check.better->name) : Json()}};
}

Json time_json(const RecordingInfo& info, const TimeFigures& time) {
    Json gaps = Json::array();
    for (const TimeGap& gap : time.gaps)
        gaps.push_back({{"after_frame", gap.after_frame}, {"seconds", gap.seconds}});
    return {{"duration_s", time.duration},
            {"median_step_s", time.median_step},
            {"synthetic", info.synthetic_times},
            {"gaps", gaps}};
}

Json lens_json(const Lens& l) {
    return {{"width", l.width},
            {"height", l.height},
            {"lens", {l.fx, l.fy, l.cx, l.cy}},
            {"distortion", {l.k1, l.k2, l.p1, l.p2, l.k3}}};
}

void print_json(const RecordingInfo& info, const InfoFigures& figures) {
    std::vector<std::string> warnings = info.warnings;
    warnings.insert(warnings.end(), figures.warnings.begin(), figures.warnings.end());
    Json json{{"path", info.path.string()}, {"profile", info.profile}};
    json["frames"] = {{"count", info.frames.size()},
                      {"first", info.frames.front()},
                      {"last", info.frames.back()}};
    json["camera"] = lens_json(info.lens);
    json["depth"] = {{"units_per_metre", info.units_per_metre}, {"max_depth_m", info.max_depth},
                     {"coverage", figures.depth.coverage},      {"near_m", figures.depth.near},
                     {"median_m", figures.depth.median},        {"far_m", figures.depth.far},
                     {"sampled_frames", figures.depth.frames}};
    json["time"] = time_json(info, figures.time);
    json["poses"] = {
        {"source", info.pose_source}, {"count", poses_in(info)}, {"unusable", info.unusable_poses}};
    json["up"] = info.up ? Json{info.up->x, info.up->y, info.up->z} : Json();
    json["assumptions"] = info.assumptions;
    json["warnings"] = warnings;
    json["geometry"] = geometry_json(figures.geometry);
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << "\n";
}

int run(const InfoOptions& options) {
    apply(options.common);
    if (!options.trajectories.empty()) {
        print_trajectory_errors(options.trajectories[0], options.trajectories[1],
                                options.common.json);
        return 0;
    }
    const Recording recording =
        open_recording(options.recording.path, open_options(options.recording));
    const std::vector<int> frames =
        select_frames(parse_frames(options.common.frames), recording.info.frames);
    const InfoFigures figures = measure_recording(recording, frames);
    if (options.common.json)
        print_json(recording.info, figures);
    else
        print_text(recording.info, figures);
    return 0;
}

}  // namespace

std::function<int()> add_info(CLI::App& subcommand) {
    const auto options = std::make_shared<InfoOptions>();
    add_recording_options(subcommand, options->recording);
    subcommand
        .add_option("--trajectory", options->trajectories,
                    "A B: only compare the poses of A with those of B (TUM files)")
        ->expected(2);
    add_common_options(subcommand, options->common);
    return [options] { return run(*options); };
}

}  // namespace inlay
