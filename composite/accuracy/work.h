// Work: what the bench measures on: a recording whose truth is known, or a scene that is rendered.
#pragma once

#include "composite/accuracy/reference.h"
#include "composite/session/prepare_scene.h"
#include "recordings/readers/recording.h"
#include "render/filter/environment_irradiance.h"
#include "render/sample/environment_sampler.h"
#include "render/scene/scene_file.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace inlay {

struct Work {
    std::string name;                    // of the folder or the scene file, without ending
    std::filesystem::path source;        // the recording's folder, or the scene file
    std::optional<Recording> recording;  // none: a scene that is rendered
    VirtualScene scene;                  // all objects; those flagged real are the room
    bool knows_room = false;             // the scene holds the real objects too
    EnvironmentSampler environment;
    double environment_bandwidth = 0;    // B_e, 1/rad
    EnvironmentIrradiance open_sky;      // of the environment
    std::optional<View> view;            // of a scene
    std::vector<int> truth_frames;       // with truth/composite, ascending
    int truth_samples = 0;               // paths per pixel; 0: unknown or no truth
    bool sensor_noise = true;            // of a recording: its depth is a sensor's, not exact
    std::vector<AssetFile> scene_files;  // that the scene was read from, its own file first
    std::vector<std::string> warnings;
};

/// Opens a folder as a recording, with the scene.json in it or `scene_file`; or a scene file with a
/// `view`. A recording needs no truth: figures against truth are then missing. Throws Error as
/// open_recording and load_scene_file, and input_missing where a recording has no scene.
Work open_work(const std::filesystem::path& path, const Settings& settings,
               const std::filesystem::path& scene_file = {});

/// The picture with the virtual objects really in it; none where the frame has no truth. Throws
/// Error (bad_data) that names the file when it is damaged or of another size than `lens`.
std::optional<Reference> truth_of_frame(const Work& work, int frame, const Lens& lens);

/// The recorded picture without 8-bit code values and noise, or none.
std::optional<Image<Rgb>> true_photograph(const Work& work, int frame);

/// The recorded pose of a frame. Throws Error (bad_data) where there is none.
Pose true_pose(const Work& work, int frame);

}  // namespace inlay
