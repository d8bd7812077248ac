#include "composite/record/record_scene.h"

#include "composite/write/atomic_file.h"
#include "composite/write/write_exr.h"
#include "composite/write/write_png.h"
#include "recordings/base/check.h"
#include "recordings/readers/trajectory.h"
#include "render/trace/picture.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <span>
#include <string>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// Truth must not share its noise with what it judges.
constexpr std::uint32_t truth_seed_offset = 0x5eed;

double time_of(const RecordSettings& settings, int frame) {
    return frame / settings.frames_per_second;
}

void write_text(const fs::path& file, const std::string& text) {
    write_file(file, std::as_bytes(std::span(text)));
}

Image<std::uint16_t> stored_depth(const Image<float>& depth, double units_per_metre) {
    Image<std::uint16_t> stored(depth.width, depth.height);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        const double units = std::round(depth.pixels[i] * units_per_metre);
        stored.pixels[i] = units > 0 && units < 65535 ? std::uint16_t(units) : 0;
    }
    return stored;
}

void write_lists(const fs::path& folder, const RecordSettings& settings) {
    std::string color = "# timestamp filename\n", depth = color;
    for (int i = 0; i < settings.frames; ++i) {
        const double t = time_of(settings, i);
        color += fmt::format("{:.6f} rgb/{:06d}.png\n", t, i);
        depth += fmt::format("{:.6f} depth/{:06d}.png\n", t, i);
    }
    write_text(folder / "rgb.txt", color);
    write_text(folder / "depth.txt", depth);
}

void write_poses(const fs::path& folder, const FilmedScene& film, const RecordSettings& settings) {
    Trajectory poses;
    for (int i = 0; i < settings.frames; ++i) {
        const double t = time_of(settings, i);
        poses.poses.push_back({std::llround(t * 1e9), {film.camera(t), ""}});
    }
    write_text(folder / "groundtruth.txt", to_tum_text(poses));
    write_text(folder / "truth" / "poses.txt", to_tum_text(poses));
}

void write_camera(const fs::path& folder, const FilmedScene& film, const RecordSettings& settings) {
    const Lens& l = film.lens;
    const nlohmann::ordered_json json{{"width", l.width},
                                      {"height", l.height},
                                      {"lens", {l.fx, l.fy, l.cx, l.cy}},
                                      {"depth_scale", settings.units_per_metre},
                                      {"up", {film.up.x, film.up.y, film.up.z}}};
    write_text(folder / "camera.json", json.dump(2) + "\n");
}

void write_picture(const fs::path& folder, const std::string& stem, const Picture& picture) {
    ExrFile exr;
    exr.picture = &picture.radiance;
    write_exr(folder / (stem + ".exr"), exr);
    exr.picture = &picture.standard_error;
    write_exr(folder / (stem + ".stderr.exr"), exr);
}

void write_truth(const fs::path& truth, const FilmedScene& film, const RecordSettings& settings,
                 int frame) {
    const double t = time_of(settings, frame);
    const std::string stem = fmt::format("{:06d}", frame);
    const PictureView view{film.lens, film.camera(t), settings.seed + truth_seed_offset,
                           std::uint32_t(frame)};
    const EnvironmentSampler environment = make_environment_sampler(film.environment);
    EmbreeSceneCache structures;
    const EmbreeScene real = structures.place(film.scene, t, true);
    const EmbreeScene all = structures.place(film.scene, t);
    write_picture(truth / "recorded", stem,
                  trace_picture(real, environment, view, settings.truth_samples));
    write_picture(truth / "composite", stem,
                  trace_picture(all, environment, view, settings.truth_samples));
    const Image<float> depth = trace_depth(real, film.lens, view.world_from_camera);
    ExrFile exr;
    exr.layers.push_back(value_layer("Z", depth));
    write_exr(truth / "depth" / (stem + ".exr"), exr);
}

}  // namespace

void validate(const RecordSettings& s) {
    require(s.frames > 0 && s.samples > 1 && s.truth_samples > 1 && s.frames_per_second > 0,
            "record: frames and rate must be positive, samples at least 2", ExitCode::usage);
    for (const int frame : s.truth_frames)
        require(frame >= 0 && frame < s.frames,
                "record: truth is asked for frame " + std::to_string(frame) + ", but there are " +
                    std::to_string(s.frames) + " frames",
                ExitCode::usage);
}

RecordedFrame film_frame(const FilmedScene& film, const RecordSettings& settings, int frame) {
    const double t = time_of(settings, frame);
    const PictureView view{film.lens, film.camera(t), settings.seed, std::uint32_t(frame)};
    EmbreeSceneCache structures;
    const EmbreeScene real = structures.place(film.scene, t, true);
    const Picture picture =
        trace_picture(real, make_environment_sampler(film.environment), view, settings.samples);
    RecordedFrame recorded;
    recorded.color = encode(picture.radiance);
    recorded.exact_depth = trace_depth(real, film.lens, view.world_from_camera);
    const Image<float> measured =
        settings.sensor_noise
            ? simulate_sensor(recorded.exact_depth, film.lens,
                              {settings.seed, std::uint32_t(frame), 0, 0}, settings.noise)
            : recorded.exact_depth;
    recorded.depth = stored_depth(measured, settings.units_per_metre);
    return recorded;
}

void record_scene(const FilmedScene& film, const RecordSettings& settings, const fs::path& folder,
                  const std::function<void(int)>& frame_done) {
    validate(settings);
    for (const char* sub : {"rgb", "depth", "truth/recorded", "truth/composite", "truth/depth"})
        make_folder(folder / sub);
    write_lists(folder, settings);
    write_poses(folder, film, settings);
    write_camera(folder, film, settings);
    ExrFile environment;
    environment.picture = &film.environment.radiance;
    environment.picture_precision = ExrPrecision::full_float;
    write_exr(folder / "truth" / "environment.exr", environment);
    for (int i = 0; i < settings.frames; ++i) {
        if (!settings.written_frames.empty() && !settings.written_frames.contains(i)) continue;
        const RecordedFrame frame = film_frame(film, settings, i);
        write_png(folder / "rgb" / fmt::format("{:06d}.png", i), frame.color);
        write_png(folder / "depth" / fmt::format("{:06d}.png", i), frame.depth);
        if (settings.truth_frames.contains(i)) write_truth(folder / "truth", film, settings, i);
        frame_done(i + 1);
    }
}

}  // namespace inlay
