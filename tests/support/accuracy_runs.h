// Tiny runs of `inlay accuracy`: a recording that the program made itself, and few samples.
#pragma once

#include "tests/support/program_runs.h"

#include <nlohmann/json.hpp>

namespace inlay::test {

/// A grey wall, the far side of a large real ball, 1.5 m away; and a white virtual ball of `radius`
/// m whose nearest point is `distance` m away, behind the camera where that is negative.
inline std::string scene_with_ball(double radius, double distance) {
    const double z = 1 - distance - radius;
    return R"({"version": 1, "environment": {"constant": [1, 1, 1]},
  "view": {"width": 32, "height": 24, "lens": [30, 30, 15.5, 11.5],
           "world_from_camera": [1,0,0,0, 0,-1,0,0, 0,0,-1,1, 0,0,0,1]},
  "objects": [
    {"name": "wall", "sphere": {"radius": 10}, "real": true,
     "transform": [1,0,0,0, 0,1,0,0, 0,0,1,-10.5, 0,0,0,1],
     "material": {"type": "diffuse", "reflectance": [0.3, 0.3, 0.3]}},
    {"name": "ball", "sphere": {"radius": )" +
           std::to_string(radius) + R"(}, "transform": [1,0,0,0, 0,1,0,0, 0,0,1,)" +
           std::to_string(z) + R"(, 0,0,0,1],
     "material": {"type": "diffuse", "reflectance": [0.9, 0.9, 0.9]}}]})";
}

inline std::filesystem::path record_ball(const TemporaryFolder& folder, const std::string& scene,
                                         const std::string& options) {
    write_file(folder / "scene.json", scene);
    const std::filesystem::path out = folder / "ball";
    const Outcome outcome =
        run_program("record " + (folder / "scene.json").string() + " --out " + out.string() +
                    " --samples 4 --truth-samples 64 --still --quiet " + options);
    if (outcome.code != 0) throw std::runtime_error("cannot record: " + outcome.err);
    return out;
}

/// Three frames, the last two with truth; made once.
inline const std::filesystem::path& ball() {
    static const TemporaryFolder folder;
    static const std::filesystem::path recording =
        record_ball(folder, scene_with_ball(0.2, 0.9), "--length 3 --truth 1,2");
    return recording;
}

/// What makes a run small: two methods, three counts of samples, a coarse model, known poses.
inline const std::vector<std::string> small_run{"--quick",
                                                "--reference-samples",
                                                "16",
                                                "--only",
                                                "samples",
                                                "--only",
                                                "unfiltered",
                                                "--only",
                                                "difference",
                                                "--set",
                                                "slam.poses=recorded",
                                                "--set",
                                                "slam.fusion.voxel_size=0.02",
                                                "--set",
                                                "slam.fusion.truncation=0.08"};

inline std::vector<std::string> arguments_for(const std::filesystem::path& work,
                                              const std::filesystem::path& out) {
    std::vector<std::string> all{"accuracy", work.string(), "--out", out.string()};
    all.insert(all.end(), small_run.begin(), small_run.end());
    return all;
}

inline Outcome accuracy(const std::filesystem::path& work, const std::filesystem::path& out,
                        const std::string& options = "") {
    std::string line;
    for (const std::string& argument : arguments_for(work, out))
        line += argument + " ";
    return run_program(line + options);
}

inline nlohmann::json report_of(const std::filesystem::path& out) {
    return nlohmann::json::parse(file_text(out / "accuracy.json"));
}

}  // namespace inlay::test
