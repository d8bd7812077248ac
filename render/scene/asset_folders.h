// Where the files of a scene may lie: beside the scene file and in folders the user names.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace inlay {

/// A file that a scene opened.
struct AssetFile {
    std::filesystem::path file;   // absolute, links followed
    std::filesystem::path place;  // relative: where a copy of the scene finds it in its own folder
};

/// Folders as the file system knows them (absolute, without links), in the order they are searched.
struct AssetFolders {
    std::vector<std::filesystem::path> folders;
    std::filesystem::path within = {};  // place of the names asked for; "" beside the scene
    /// What was opened through this value and its copies, each file and place once.
    std::shared_ptr<std::vector<AssetFile>> opened = std::make_shared<std::vector<AssetFile>>();
};

/// The folder of `scene_file`, then `more`. Throws Error (input_missing) where one is no folder.
AssetFolders asset_folders(const std::filesystem::path& scene_file,
                           const std::vector<std::filesystem::path>& more);

/// Whether a path, its links followed, lies within one of the folders.
bool lies_within(const AssetFolders& assets, const std::filesystem::path& path);

/// Adds a file to what was opened.
void note_opened(const AssetFolders& assets, const AssetFile& opened);

/// Where the file that was found last as `file` has its place; its own name if it never was.
std::filesystem::path place_of(const AssetFolders& assets, const std::filesystem::path& file);

/// The first file called `name` in the folders; it counts as opened. `place` says in messages who
/// asks for it. Throws Error: bad_data for an empty or absolute name, one with "..", and a link
/// that leads out of all the folders; input_missing where there is no such file.
std::filesystem::path find_asset(const AssetFolders& assets, const std::string& name,
                                 const std::string& place);

}  // namespace inlay
