// A recording whose truth is known: a scene filmed by the path tracer, as a TUM RGB-D folder.
#pragma once

#include "recordings/base/environment_map.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "recordings/synthetic/camera_path.h"
#include "recordings/synthetic/sensor_noise.h"
#include "render/sample/environment_sampler.h"
#include "render/scene/virtual_scene.h"
#include "render/trace/embree_scene.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace inlay {

/// What is filmed. Objects flagged `real` are in the recording, all of them in its true composite.
struct FilmedScene {
    VirtualScene scene;
    EnvironmentMap environment;
    Lens lens;
    glm::dvec3 up{0, 1, 0};                   // world
    std::function<Pose(double time)> camera;  // world_from_camera at a time (s)
    std::vector<std::string> warnings;        // what had to be mended in its files
};

struct RecordSettings {
    int frames = 30;
    double frames_per_second = 30;
    int samples = 256;             // paths per pixel of the recorded color
    int truth_samples = 1024;      // paths per pixel of the truth
    std::set<int> written_frames;  // of color, depth and truth; empty: all. Lists hold all frames
    std::set<int> truth_frames{0};
    bool sensor_noise = true;
    DepthNoiseSettings noise;
    double units_per_metre = 5000;  // of the stored depth
    std::uint32_t seed = 1;
};

/// Throws Error (usage) for counts that are not positive or truth frames outside the recording.
void validate(const RecordSettings& settings);

/// What the caller of a long recording wants to know and to say. Both may be empty.
struct RecordWatch {
    std::function<void(int finished)> frame_done;  // after each frame, with the number of finished
    std::function<bool()> asked_to_stop;           // between frames, and between a frame's passes
};

struct RecordResult {
    int finished = 0;                   // frames, with their truth; all, unless asked to stop
    std::uint64_t dropped_samples = 0;  // not finite, left out of every mean
};

/// Writes frames, lists, camera.json and truth/ in the layout of a TUM RGB-D folder; record.json,
/// which marks the folder as complete, is left to the caller. Numbers of a frame depend on
/// (settings.seed, frame) alone, so that any frame can be made again by itself.
RecordResult record_scene(const FilmedScene& film, const RecordSettings& settings,
                          const std::filesystem::path& folder, const RecordWatch& watch = {});

/// How many frames record_scene() is to write.
int wanted_frames(const RecordSettings& settings);

/// What is the same for all frames of a film: tables of the environment, and one acceleration
/// structure for each mesh. `film` must outlive it.
struct FilmSet {
    const FilmedScene& film;
    EnvironmentSampler environment;
    EmbreeSceneCache structures;
};

FilmSet prepare_film(const FilmedScene& film);

/// One frame as the sensor stores it.
struct RecordedFrame {
    Image<EncodedRgb> color;
    Image<std::uint16_t> depth;  // 0 = not measured
    Image<float> exact_depth;    // m
    std::uint64_t dropped_samples = 0;
};

/// The set keeps the structures of the meshes that it meets first.
RecordedFrame film_frame(FilmSet& set, const RecordSettings& settings, int frame);

}  // namespace inlay
