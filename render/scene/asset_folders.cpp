#include "render/scene/asset_folders.h"

#include "recordings/base/check.h"

#include <algorithm>

namespace inlay {

namespace fs = std::filesystem;

AssetFolders asset_folders(const fs::path& scene_file, const std::vector<fs::path>& more) {
    std::vector<fs::path> wanted{fs::absolute(scene_file).parent_path()};
    wanted.insert(wanted.end(), more.begin(), more.end());
    AssetFolders assets;
    for (const fs::path& folder : wanted) {
        std::error_code fault;
        require(fs::is_directory(folder, fault), folder.string() + ": no such folder",
                ExitCode::input_missing);
        assets.folders.push_back(fs::canonical(folder, fault));
        require(!fault, folder.string() + ": " + fault.message(), ExitCode::input_missing);
    }
    return assets;
}

bool lies_within(const AssetFolders& assets, const fs::path& path) {
    std::error_code fault;
    const fs::path real = fs::weakly_canonical(path, fault);
    if (fault) return false;
    return std::any_of(assets.folders.begin(), assets.folders.end(), [&](const fs::path& folder) {
        return std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first ==
               folder.end();
    });
}

void note_opened(const AssetFolders& assets, const AssetFile& opened) {
    const bool known = std::any_of(
        assets.opened->begin(), assets.opened->end(),
        [&](const AssetFile& o) { return o.file == opened.file && o.place == opened.place; });
    if (!known) assets.opened->push_back(opened);
}

fs::path place_of(const AssetFolders& assets, const fs::path& file) {
    const auto found = std::find_if(assets.opened->rbegin(), assets.opened->rend(),
                                    [&](const AssetFile& o) { return o.file == file; });
    return found != assets.opened->rend() ? found->place : file.filename();
}

fs::path find_asset(const AssetFolders& assets, const std::string& name, const std::string& place) {
    const fs::path relative(name);
    const bool climbs = std::find(relative.begin(), relative.end(), "..") != relative.end();
    require(
        !name.empty() && name.find('\0') == std::string::npos && !relative.is_absolute() && !climbs,
        place + ": the file name \"" + name + "\" is empty, absolute or climbs with \"..\"; " +
            "name a file beside the scene file or in a folder given with --assets");
    std::string searched;
    for (const fs::path& folder : assets.folders) {
        const fs::path file = folder / relative;
        searched += "\n  " + folder.string();
        std::error_code ignored;
        if (!fs::is_regular_file(file, ignored)) continue;
        require(lies_within(assets, file),
                place + ": " + file.string() +
                    " is a link that leads out of the scene's folders; " +
                    "put the file itself there, or add its folder with --assets");
        note_opened(assets, {fs::canonical(file), (assets.within / relative).lexically_normal()});
        return fs::canonical(file);
    }
    throw Error(ExitCode::input_missing, place + ": no file \"" + name + "\" in" + searched +
                                             "\nAdd its folder with --assets DIR");
}

}  // namespace inlay
