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
#include <optional>
#include <string>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// Truth must not share its noise with what it judges.
constexpr std::uint32_t truth_seed_offset = 0x5eed;

double time_of(const RecordSettings& settings, int frame) {
    return frame / settings.frames_per_second;
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

bool stopped(const RecordWatch& watch) { return watch.asked_to_stop && watch.asked_to_stop(); }

/// Returns the samples that were dropped; none where it was asked to stop before its last file.
std::optional<std::uint64_t> write_truth(const fs::path& truth, FilmSet& set,
                                         const RecordSettings& settings, int frame,
                                         const RecordWatch& watch) {
    const FilmedScene& film = set.film;
    const double t = time_of(settings, frame);
    const std::string stem = fmt::format("{:06d}", frame);
    const PictureView view{film.lens, film.camera(t), settings.seed + truth_seed_offset,
                           std::uint32_t(frame)};
    std::uint64_t dropped = 0;
    const auto trace = [&](const EmbreeScene& objects, const char* kind) {
        if (stopped(watch)) return false;
        const Picture picture =
            trace_picture(objects, set.environment, view, settings.truth_samples);
        dropped += picture.dropped_samples;
        write_picture(truth / kind, stem, picture);
        return true;
    };
    const EmbreeScene real = set.structures.place(film.scene, t, true);
    if (!trace(real, "recorded") || !trace(set.structures.place(film.scene, t), "composite"))
        return std::nullopt;
    const Image<float> depth = trace_depth(real, film.lens, view.world_from_camera);
    ExrFile exr;
    exr.layers.push_back(value_layer("Z", depth));
    write_exr(truth / "depth" / (stem + ".exr"), exr);
    return dropped;
}

void write_frame(const fs::path& folder, const RecordedFrame& recorded, int frame) {
    const std::string name = fmt::format("{:06d}.png", frame);
    write_png(folder / "rgb" / name, recorded.color);
    write_png(folder / "depth" / name, recorded.depth);
}

void write_environment(const fs::path& truth, const EnvironmentMap& map) {
    ExrFile environment;
    environment.picture = &map.radiance;
    environment.picture_precision = ExrPrecision::full_float;
    write_exr(truth / "environment.exr", environment);
}

bool wanted(const RecordSettings& settings, int frame) {
    return settings.written_frames.empty() || settings.written_frames.contains(frame);
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

int wanted_frames(const RecordSettings& settings) {
    int count = 0;
    for (int i = 0; i < settings.frames; ++i)
        count += wanted(settings, i);
    return count;
}

FilmSet prepare_film(const FilmedScene& film) {
    return {film, make_environment_sampler(film.environment), {}};
}

RecordedFrame film_frame(FilmSet& set, const RecordSettings& settings, int frame) {
    const FilmedScene& film = set.film;
    const double t = time_of(settings, frame);
    const PictureView view{film.lens, film.camera(t), settings.seed, std::uint32_t(frame)};
    const EmbreeScene real = set.structures.place(film.scene, t, true);
    const Picture picture = trace_picture(real, set.environment, view, settings.samples);
    RecordedFrame recorded;
    recorded.color = encode(picture.radiance);
    recorded.dropped_samples = picture.dropped_samples;
    recorded.exact_depth = trace_depth(real, film.lens, view.world_from_camera);
    const Image<float> measured =
        settings.sensor_noise
            ? simulate_sensor(recorded.exact_depth, film.lens,
                              {settings.seed, std::uint32_t(frame), 0, 0}, settings.noise)
            : recorded.exact_depth;
    recorded.depth = stored_depth(measured, settings.units_per_metre);
    return recorded;
}

RecordResult record_scene(const FilmedScene& film, const RecordSettings& settings,
                          const fs::path& folder, const RecordWatch& watch) {
    validate(settings);
    for (const char* sub : {"rgb", "depth", "truth/recorded", "truth/composite", "truth/depth"})
        make_folder(folder / sub);
    write_lists(folder, settings);
    write_poses(folder, film, settings);
    write_camera(folder, film, settings);
    write_environment(folder / "truth", film.environment);
    FilmSet set = prepare_film(film);
    RecordResult result;
    for (int i = 0; i < settings.frames; ++i) {
        if (!wanted(settings, i)) continue;
        if (stopped(watch)) break;
        const RecordedFrame recorded = film_frame(set, settings, i);
        write_frame(folder, recorded, i);
        result.dropped_samples += recorded.dropped_samples;
        if (settings.truth_frames.contains(i)) {
            const auto dropped = write_truth(folder / "truth", set, settings, i, watch);
            if (!dropped) break;
            result.dropped_samples += *dropped;
        }
        ++result.finished;
        if (watch.frame_done) watch.frame_done(result.finished);
    }
    return result;
}

}  // namespace inlay
