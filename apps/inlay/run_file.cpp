#include "apps/inlay/run_file.h"

#include "composite/accuracy/machine.h"
#include "composite/plan/explain.h"
#include "composite/write/atomic_file.h"
#include "composite/write/file_content.h"
#include "recordings/base/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <initializer_list>
#include <optional>
#include <stdexcept>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Of the numbers, times and recorded poses of all frames.
std::string fingerprint_of_frames(const RecordingInfo& info) {
    std::string text;
    for (std::size_t i = 0; i < info.frames.size(); ++i) {
        text += fmt::format(" {}:{}", info.frames[i], info.times[i]);
        if (!info.world_from_camera[i]) continue;
        const Pose& pose = *info.world_from_camera[i];
        for (int column = 0; column < 3; ++column)
            text += fmt::format(" {} {} {} {}", pose.rotation[column].x, pose.rotation[column].y,
                                pose.rotation[column].z, pose.translation[column]);
    }
    return fingerprint_of(text);
}

/// What identifies a recording, and how it is read, without decoding it.
Json describe(const RecordingInfo& info) {
    const Lens& l = info.lens;
    return {{"name", name_of(info)},
            {"profile", info.profile},
            {"frames", info.frames.size()},
            {"size", {l.width, l.height}},
            {"lens", {l.fx, l.fy, l.cx, l.cy}},
            {"distortion", {l.k1, l.k2, l.p1, l.p2, l.k3}},
            {"depth_scale", info.units_per_metre},
            {"max_depth_m", info.max_depth},
            {"up", info.up ? Json{info.up->x, info.up->y, info.up->z} : Json()},
            {"poses", info.pose_source},
            {"fingerprint", fingerprint_of_frames(info)}};
}

Json describe_scene(const RunDescription& run) {
    Json files = Json::object();
    for (const AssetFile& asset : run.files)
        files[asset.place.generic_string()] = fingerprint_of(content_of(asset.file));
    return {{"name", run.scene.filename().string()},
            {"fingerprint", fingerprint_of(content_of(run.scene))},
            {"files", files}};
}

Json describe_governor(const RunDescription& run) {
    Json choices = Json::object();
    for (const auto& [frame, samples] : run.choices)
        choices[std::to_string(frame)] = samples;
    const auto number = [](const std::optional<double>& v) { return v ? Json(*v) : Json(); };
    return {{"time_per_frame_ms", number(run.goal.ms_per_frame)},
            {"error", number(run.goal.error)},
            {"choices", choices}};
}

Json describe(const RecordingInfo& recording, const RunDescription& run) {
    Json settings;
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(run.settings);
    Json json{{"version", INLAY_VERSION},
              {"command", run.command},
              {"frames", run.frames},
              {"shard", run.shard},
              {"assets", run.asset_folders},
              {"scene", describe_scene(run)},
              {"settings", settings},
              {"layers", run.layers},
              {"recording", describe(recording)},
              {"plan", Json::parse(to_json_text(run.plan))}};
    if (run.goal.ms_per_frame || run.goal.error || !run.choices.empty())
        json["governor"] = describe_governor(run);
    return json;
}

std::string shown(const Json& value) {
    return value.is_null() ? "absent" : value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The first member, in the order of `now` and then of `before`, in which the two differ.
std::optional<std::string> difference(const Json& before, const Json& now,
                                      const std::string& name) {
    if (before == now) return std::nullopt;
    if (!before.is_object() || !now.is_object())
        return name + " was " + shown(before) + " and is " + shown(now);
    for (const Json* both : {&now, &before})
        for (const auto& [key, unused] : both->items())
            if (const auto found =
                    difference(before.value(key, Json()), now.value(key, Json()), name + " " + key))
                return found;
    return name + " has another order";
}

Json read_run(const fs::path& file) {
    Json json = Json::parse(content_of(file), nullptr, /*allow_exceptions=*/false);
    require(json.is_object(),
            file.string() + ": not valid JSON, so it says nothing of its run; choose another file");
    return json;
}

void require_same_run(const fs::path& file, const Json& before, const Json& now,
                      std::initializer_list<const char*> members) {
    for (const char* key : members) {
        const auto found = difference(before.value(key, Json()), now[key], key);
        require(!found,
                file.string() + ": this run was made with other " + key + ": " +
                    found.value_or("") + "; go on with the same, or choose another --out",
                ExitCode::usage);
    }
}

/// Throws std::exception where it is none.
std::map<int, int> choices_from(const Json& json) {
    const std::vector<int> ladder = sample_ladder();
    std::map<int, int> choices;
    for (const auto& [frame, samples] : json.items()) {
        std::size_t end = 0;
        const int number = std::stoi(frame, &end);
        if (end != frame.size() || !samples.is_number_integer() ||
            !std::binary_search(ladder.begin(), ladder.end(), samples.get<int>()))
            throw std::invalid_argument(frame);
        choices[number] = samples.get<int>();
    }
    return choices;
}

}  // namespace

std::string name_of(const RecordingInfo& recording) {
    const fs::path path = fs::absolute(recording.path).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

GovernedBefore read_governed(const fs::path& file, const RecordingInfo& recording,
                             const RunDescription& run) {
    const Json json = read_run(file);
    if (!json.contains("governor")) return {};
    require_same_run(file, json, describe(recording, run),
                     {"version", "recording", "scene", "settings"});
    try {
        const Json& governor = json.at("governor");
        const auto number = [&](const char* key) {
            const Json& value = governor.at(key);
            return value.is_null() ? std::nullopt : std::optional(value.get<double>());
        };
        return {{number("time_per_frame_ms"), number("error")},
                choices_from(governor.at("choices"))};
    } catch (const std::exception&) {
        throw Error(ExitCode::bad_data,
                    file.string() +
                        ": governor: expected time_per_frame_ms, error and choices, "
                        "the samples of each frame; make the run again");
    }
}

std::string price_key(const RecordingInfo& recording, const RunDescription& run, int threads) {
    const Json all = describe(recording, run);
    const Machine machine = this_machine();
    const Json key{{"version", all["version"]},     {"cpu", machine.cpu},
                   {"cores", machine.threads},      {"threads", threads},
                   {"recording", all["recording"]}, {"scene", all["scene"]},
                   {"settings", all["settings"]}};
    return key.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void write_run_file(const fs::path& folder, const RecordingInfo& recording,
                    const RunDescription& run) {
    const Json description = describe(recording, run);
    const fs::path file = folder / "run.json";
    if (fs::exists(file))
        require_same_run(file, read_run(file), description,
                         {"version", "recording", "scene", "settings", "layers"});
    write_text(file, description.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace inlay
