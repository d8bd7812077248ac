// run.json: what makes a replay the run that it is, and what a resumed one must have in common.
#pragma once

#include "composite/plan/effect_plan.h"
#include "composite/session/settings.h"
#include "recordings/readers/recording.h"
#include "render/scene/scene_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace inlay {

/// One run of the command. Frames, shard and asset folders are as the user gave them; they and the
/// command may differ when a run is resumed, all else may not.
struct RunDescription {
    std::vector<std::string> command;  // all arguments
    std::string frames, shard;
    std::vector<std::string> asset_folders;
    std::filesystem::path scene;
    std::vector<AssetFile> files;  // of the scene: meshes, textures, environment
    Settings settings;
    std::vector<std::string> layers;
    EffectPlan plan;
};

/// The name of the recording's folder, whether or not its path was given with a slash at its end.
std::string name_of(const RecordingInfo& recording);

/// Writes run.json of an output folder. One that is there already must describe the same recording,
/// scene with the contents of its files, settings and layers. Throws Error: usage, naming what
/// differs and both values; bad_data for a file that is no JSON; cannot_create, disk_fault.
void write_run_file(const std::filesystem::path& folder, const RecordingInfo& recording,
                    const RunDescription& run);

}  // namespace inlay
