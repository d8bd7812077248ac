#include "apps/inlay/run_file.h"

#include "composite/plan/explain.h"
#include "composite/write/atomic_file.h"
#include "composite/write/file_content.h"
#include "recordings/base/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <optional>

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

Json describe(const RecordingInfo& recording, const RunDescription& run) {
    Json settings;
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(run.settings);
    return {{"version", INLAY_VERSION},
            {"command", run.command},
            {"frames", run.frames},
            {"shard", run.shard},
            {"assets", run.asset_folders},
            {"scene", describe_scene(run)},
            {"settings", settings},
            {"layers", run.layers},
            {"recording", describe(recording)},
            {"plan", Json::parse(to_json_text(run.plan))}};
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

void require_same_run(const fs::path& file, const Json& now) {
    const Json before = Json::parse(content_of(file), nullptr, /*allow_exceptions=*/false);
    require(before.is_object(),
            file.string() + ": not valid JSON, so the run cannot be resumed; choose another --out");
    for (const char* key : {"version", "recording", "scene", "settings", "layers"}) {
        const auto found = difference(before.value(key, Json()), now[key], key);
        require(!found,
                file.string() + ": this run was made with other " + key + ": " +
                    found.value_or("") + "; resume with the same, or choose another --out",
                ExitCode::usage);
    }
}

}  // namespace

std::string name_of(const RecordingInfo& recording) {
    const fs::path path = fs::absolute(recording.path).lexically_normal();
    return (path.has_filename() ? path : path.parent_path()).filename().string();
}

void write_run_file(const fs::path& folder, const RecordingInfo& recording,
                    const RunDescription& run) {
    const Json description = describe(recording, run);
    const fs::path file = folder / "run.json";
    if (fs::exists(file)) require_same_run(file, description);
    write_text(file, description.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace inlay
