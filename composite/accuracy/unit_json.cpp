#include "composite/accuracy/unit_json.h"

#include "recordings/base/check.h"

#include <nlohmann/json.hpp>

namespace inlay {

using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Cost, wall_ms, cpu_ms)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(RayCounts, primary, virtual_shadow, virtual_indirect,
                                   real_shadow, real_indirect)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameRun, frame, slam_ms, trace, rays)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(FrameError, mean_square, mean_square_influenced, reference_power,
                                   psnr, ssim, flip, influenced)

namespace {

template <class Value>
json optional_json(const std::optional<Value>& value) {
    return value ? json(*value) : json();
}

template <class Value>
std::optional<Value> optional_from(const json& in) {
    if (in.is_null()) return std::nullopt;
    return in.get<Value>();
}

json json_of(const MethodRun& run) {
    return {{"method", run.method},
            {"temporal", run.temporal},
            {"width", run.width},
            {"frame", run.frame},
            {"filter", run.filter},
            {"composite", run.composite},
            {"trace", optional_json(run.trace)},
            {"rays", optional_json(run.rays)},
            {"converged", optional_json(run.converged)},
            {"truth", optional_json(run.truth)},
            {"flicker", optional_json(run.flicker)},
            {"failed", run.failed}};
}

MethodRun run_from(const json& in) {
    MethodRun run;
    run.method = in.at("method");
    run.temporal = in.at("temporal");
    run.width = in.at("width");
    run.frame = in.at("frame");
    run.filter = in.at("filter");
    run.composite = in.at("composite");
    run.trace = optional_from<Cost>(in.at("trace"));
    run.rays = optional_from<RayCounts>(in.at("rays"));
    run.converged = optional_from<FrameError>(in.at("converged"));
    run.truth = optional_from<FrameError>(in.at("truth"));
    run.flicker = optional_from<double>(in.at("flicker"));
    run.failed = in.at("failed");
    return run;
}

}  // namespace

std::string to_json_text(const UnitRun& unit) {
    json out{{"work", unit.work},       {"knob", unit.knob},       {"value", unit.value},
             {"repeat", unit.repeat},   {"primary", unit.primary}, {"secondary", unit.secondary},
             {"peak_mb", unit.peak_mb}, {"frames", unit.frames},   {"runs", json::array()}};
    for (const MethodRun& run : unit.runs)
        out["runs"].push_back(json_of(run));
    return out.dump() + "\n";
}

UnitRun unit_from_json(const std::string& text, const std::string& place) {
    try {
        const json in = json::parse(text);
        UnitRun unit;
        unit.work = in.at("work");
        unit.knob = in.at("knob");
        unit.value = in.at("value");
        unit.repeat = in.at("repeat");
        unit.primary = in.at("primary");
        unit.secondary = in.at("secondary");
        unit.peak_mb = in.at("peak_mb");
        unit.frames = in.at("frames").get<std::vector<FrameRun>>();
        for (const json& run : in.at("runs"))
            unit.runs.push_back(run_from(run));
        return unit;
    } catch (const nlohmann::json::exception& error) {
        throw Error(ExitCode::bad_data, place + ": not a finished measurement (" + error.what() +
                                            "); delete the file and resume");
    }
}

}  // namespace inlay
