// The works that are measured when none is named: the project's own scenes, recorded small.
#pragma once

#include "composite/accuracy/work.h"
#include "composite/record/record_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace inlay {

struct BuiltInSettings {
    glm::ivec2 size{160, 120};  // px
    int frames = 12;
    int samples = 64;          // paths per pixel of the recorded colour
    int truth_samples = 1024;  // paths per pixel of the truth
    std::vector<int> truth_frames{5, 11};
};

/// desk and what can go wrong: a hot sun, curved gloss under a soft sky, contact, motion.
const std::vector<std::string>& built_in_names();

/// Records the scene `name` of `scenes` into `folder`/`name`, unless it stands there complete, and
/// opens it. Throws Error as open_work, interrupted when `watch` asks to stop,
/// and usage where the folder holds a recording made with other settings or of another scene.
Work built_in_work(const std::string& name, const std::filesystem::path& scenes,
                   const std::filesystem::path& folder, const BuiltInSettings& settings,
                   const RecordWatch& watch = {[](int) {}, [] { return false; }});

}  // namespace inlay
