#include "composite/session/known_recording.h"

#include "composite/session/reconstruction_json.h"
#include "composite/write/atomic_file.h"
#include "composite/write/cache_folder.h"
#include "composite/write/file_content.h"
#include "recordings/base/check.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <optional>
#include <system_error>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A file's name, size and time of change, as far as they can be told.
std::string stamp_of(const fs::path& file) {
    std::error_code unknown;
    const auto size = fs::file_size(file, unknown);
    const auto time = fs::last_write_time(file, unknown).time_since_epoch().count();
    return fmt::format("{}:{}:{}\n", file.generic_string(), size, time);
}

std::string stamps_below(const fs::path& folder) {
    std::vector<std::string> stamps;
    const auto followed = fs::directory_options::follow_directory_symlink;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, followed))
        if (entry.is_regular_file()) stamps.push_back(stamp_of(entry.path()));
    std::sort(stamps.begin(), stamps.end());
    std::string text;
    for (const std::string& stamp : stamps)
        text += stamp;
    return text;
}

/// Names all that poses depend on: the recording and how it is read, settings, this program.
std::string key_of(const RecordingInfo& info, const Settings& settings) {
    const Lens& l = info.lens;
    std::string text = stamp_of(fs::canonical("/proc/self/exe")) + stamps_below(info.path);
    text +=
        fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {}\n", l.width, l.height, l.fx, l.fy, l.cx,
                    l.cy, l.k1, l.k2, l.k3, l.p1, l.p2, info.units_per_metre, info.max_depth);
    text += info.profile + "\n";
    for (std::size_t i = 0; i < info.frames.size(); ++i) {
        const Pose pose = info.world_from_camera[i].value_or(Pose{});
        text += fmt::format("{} {} {} {} {} {}\n", info.frames[i], info.times[i],
                            pose.translation.x, pose.translation.y, pose.translation.z,
                            glm::length(pose.rotation[0] + 2.0 * pose.rotation[1]));
    }
    for (const SettingRow& row : setting_rows())
        if (row.name.starts_with("slam.")) text += row.name + "=" + row.get(settings) + "\n";
    return text;
}

/// The frames that were kept for `key`; nothing where there are none, or their file cannot be
/// understood.
std::optional<Reconstruction> kept_frames(const fs::path& file, const std::string& key,
                                          const RecordingInfo& info) {
    std::error_code unreadable;
    if (!fs::exists(file, unreadable)) return std::nullopt;
    try {
        const Json json = Json::parse(content_of(file));
        if (json.at("key").get<std::string>() != fingerprint_of(key)) return std::nullopt;
        Reconstruction kept = reconstruction_from(json);
        if (kept.frames.size() != info.frames.size()) return std::nullopt;
        return kept;
    } catch (const std::exception&) {  // damaged: it is tracked again
        return std::nullopt;
    }
}

void keep_frames(const fs::path& file, const std::string& key, const Reconstruction& result) {
    try {
        make_folder(file.parent_path());
        Json json = to_json(result);
        json["key"] = fingerprint_of(key);
        write_text(file, json.dump());
    } catch (const Error&) {  // it will be tracked again
    }
}

}  // namespace

FrameSource frames_of(const Recording& recording) {
    return {recording.info.frames, recording.info.times,
            [&recording](int i) { return recording.load(recording.info.frames[std::size_t(i)]); }};
}

std::shared_ptr<const Reconstruction> know_recording(const Recording& recording,
                                                     const Settings& settings, const GoOn& go_on) {
    if (!settings.slam.look_ahead) return nullptr;
    const std::string key = key_of(recording.info, settings);
    const fs::path folder = cache_folder();
    const fs::path file = folder / ("poses-" + fingerprint_of(key) + ".json");
    if (auto kept = folder.empty() ? std::nullopt : kept_frames(file, key, recording.info)) {
        kept->complete = fuse_recording(*kept, frames_of(recording), settings.slam, go_on);
        return std::make_shared<const Reconstruction>(*std::move(kept));
    }
    auto result = reconstruct_afresh(recording, settings, go_on);
    if (result->complete && !folder.empty()) keep_frames(file, key, *result);
    return result;
}

std::shared_ptr<const Reconstruction> reconstruct_afresh(const Recording& recording,
                                                         const Settings& settings,
                                                         const GoOn& go_on) {
    if (!settings.slam.look_ahead) return nullptr;
    const PoseSource poses =
        settings.use_recorded_poses ? PoseSource::recorded : PoseSource::tracked;
    return std::make_shared<const Reconstruction>(
        reconstruct_recording(frames_of(recording), settings.slam, poses, go_on));
}

std::string full_model_text(const VoxelVolume& volume) {
    if (volume.refused == 0) return "";
    return fmt::format(
        "the model is full at {} MB: {} times a place found no room in it; allow more by --set "
        "slam.fusion.memory=MB, or take larger voxels",
        volume.bricks.size() * sizeof(Brick) >> 20, volume.refused);
}

int position_of(const Reconstruction& known, int number) {
    const auto frame =
        std::find_if(known.frames.begin(), known.frames.end(),
                     [&](const ReconstructedFrame& f) { return f.number == number; });
    return frame == known.frames.end() ? -1 : int(frame - known.frames.begin());
}

}  // namespace inlay
