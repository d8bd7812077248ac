#include "composite/accuracy/work_fingerprint.h"

#include "composite/write/file_content.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// Regular files below a folder in the order of their names, without those below `apart`.
std::vector<fs::path> files_below(const fs::path& folder, const fs::path& apart) {
    std::vector<fs::path> files;
    if (!fs::is_directory(folder)) return files;
    for (auto entry = fs::recursive_directory_iterator(folder); entry != fs::end(entry); ++entry) {
        if (entry->is_directory() && !apart.empty() && fs::equivalent(entry->path(), apart))
            entry.disable_recursion_pending();
        if (entry->is_regular_file()) files.push_back(entry->path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

std::string of_names_and_sizes(const fs::path& folder, const fs::path& apart) {
    std::string text;
    for (const fs::path& file : files_below(folder, apart))
        text += fmt::format("{}:{}\n", fs::relative(file, folder).generic_string(),
                            fs::file_size(file));
    return fingerprint_of(text);
}

std::string of_contents(const fs::path& folder) {
    std::string text;
    for (const fs::path& file : files_below(folder, {}))
        text += fmt::format("{}:{}\n", fs::relative(file, folder).generic_string(),
                            fingerprint_of(content_of(file)));
    return fingerprint_of(text);
}

/// With the times and the lens that go with them.
std::string of_poses(const RecordingInfo& info) {
    const Lens& l = info.lens;
    std::string text = fmt::format("{} {} {} {} {}", l.fx, l.fy, l.cx, l.cy, info.units_per_metre);
    for (std::size_t i = 0; i < info.frames.size(); ++i) {
        text += fmt::format("\n{}:{}", info.frames[i], info.times[i]);
        if (!info.world_from_camera[i]) continue;
        const Pose& pose = *info.world_from_camera[i];
        for (int column = 0; column < 3; ++column) {
            const glm::dvec3 axis = pose.rotation[column];
            text += fmt::format(" {} {} {} {}", axis.x, axis.y, axis.z, pose.translation[column]);
        }
    }
    return fingerprint_of(text);
}

}  // namespace

std::vector<AssetFile> files_of(const fs::path& file, const SceneFile& scene) {
    std::vector<AssetFile> files{{file, file.filename()}};
    files.insert(files.end(), scene.files.begin(), scene.files.end());
    return files;
}

std::string fingerprint_of_scene(const std::vector<AssetFile>& files) {
    std::string text;
    for (const AssetFile& asset : files)
        text += fmt::format("{}:{}\n", asset.place.generic_string(),
                            fingerprint_of(content_of(asset.file)));
    return fingerprint_of(text);
}

std::map<std::string, std::string> fingerprints_of(const Work& work, const fs::path& apart) {
    std::map<std::string, std::string> result{{"scene", fingerprint_of_scene(work.scene_files)}};
    if (!work.recording) return result;
    result["files"] = of_names_and_sizes(work.source, apart);
    result["poses"] = of_poses(work.recording->info);
    result["truth"] = of_contents(work.source / "truth");
    return result;
}

}  // namespace inlay
