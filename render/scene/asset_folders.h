// Where the files of a scene may lie: beside the scene file and in folders the user names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace inlay {

/// Folders as the file system knows them (absolute, without links), in the order they are searched.
struct AssetFolders {
    std::vector<std::filesystem::path> folders;
};

/// The folder of `scene_file`, then `more`. Throws Error (input_missing) where one is no folder.
AssetFolders asset_folders(const std::filesystem::path& scene_file,
                           const std::vector<std::filesystem::path>& more);

/// Whether a path, its links followed, lies within one of the folders.
bool lies_within(const AssetFolders& assets, const std::filesystem::path& path);

/// The first file called `name` in the folders. `place` says in messages who asks for it. Throws
/// Error: bad_data for an empty or absolute name, one with "..", and a link that leads out of all
/// the folders; input_missing where there is no such file.
std::filesystem::path find_asset(const AssetFolders& assets, const std::string& name,
                                 const std::string& place);

}  // namespace inlay
