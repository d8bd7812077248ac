// run.json: what makes a replay the run that it is, and what a resumed one must have in common.
#pragma once

#include "composite/govern/governor.h"
#include "composite/plan/effect_plan.h"
#include "composite/session/settings.h"
#include "recordings/readers/recording.h"
#include "render/scene/scene_file.h"

#include <filesystem>
#include <map>
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
    Goal goal;                   // of a governor; neither: none
    std::map<int, int> choices;  // samples of each frame, where a governor chooses or has chosen
};

/// The name of the recording's folder, whether or not its path was given with a slash at its end.
std::string name_of(const RecordingInfo& recording);

/// What a governor was asked for and chose in the run that `file`, a run.json, describes: nothing
/// where it had none. Throws Error: input_missing; bad_data for a file that cannot be understood;
/// usage where its recording, scene or settings are not those of `run`.
struct GovernedBefore {
    Goal goal;
    std::map<int, int> choices;
};
GovernedBefore read_governed(const std::filesystem::path& file, const RecordingInfo& recording,
                             const RunDescription& run);

/// Names all that the prices of a run's samples depend on: the machine with `threads` of its cores,
/// the program, the recording, the scene and the settings.
std::string price_key(const RecordingInfo& recording, const RunDescription& run, int threads);

/// Writes run.json of an output folder. One that is there already must describe the same recording,
/// scene with the contents of its files, settings and layers. Throws Error: usage, naming what
/// differs and both values; bad_data for a file that is no JSON; cannot_create, disk_fault.
void write_run_file(const std::filesystem::path& folder, const RecordingInfo& recording,
                    const RunDescription& run);

}  // namespace inlay
