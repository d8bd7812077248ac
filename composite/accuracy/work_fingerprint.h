// What a work holds, as short names of its contents, so that a change of it does not go unseen.
#pragma once

#include "composite/accuracy/work.h"

#include <map>
#include <string>

namespace inlay {

/// By what it is of: `scene` (the scene file and all that it names, contents), and of a recording
/// `files` (names and sizes of all but what lies under `apart`), `poses` and `truth` (contents).
/// Throws Error (input_missing) that names a file that cannot be read.
std::map<std::string, std::string> fingerprints_of(const Work& work,
                                                   const std::filesystem::path& apart = {});

/// Of a scene file and all that it names, contents.
std::string fingerprint_of_scene(const std::vector<AssetFile>& files);

/// The scene file itself and what it names.
std::vector<AssetFile> files_of(const std::filesystem::path& file, const SceneFile& scene);

}  // namespace inlay
