// What reconstruction costs: processor time per frame over a recording, and per stage at its end.
//
//   bench_slam RECORDING [FRAMES] [fast|accurate] [POSES.txt]
//
// Frames are decoded beforehand. With a file, the poses are written to it (TUM form, one line per
// frame, lost ones included).
#include "recordings/base/check.h"
#include "recordings/base/keep_memory.h"
#include "recordings/base/parallel.h"
#include "recordings/readers/recording.h"
#include "recordings/readers/trajectory.h"
#include "slam/depth/depth_pyramid.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/mapping/reconstruct_recording.h"
#include "slam/mesh/extract_mesh.h"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace inlay {
namespace {

/// Processor time of all threads, user and system, in ms.
double cpu_ms() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
        return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec);
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

double peak_mb() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024;
}

/// Median processor time of a stage over a few runs, ms.
void time_stage(const char* name, const std::function<void()>& work) {
    std::vector<double> times;
    for (int i = 0; i < 7; ++i) {
        const double before = cpu_ms();
        work();
        times.push_back(cpu_ms() - before);
    }
    std::sort(times.begin(), times.end());
    std::printf("  %-28s %8.1f\n", name, times[times.size() / 2]);
}

/// Shares of the frame's measured pixels that the model has, and of the image that it fills; and
/// the median angle (degrees) between the normals of horizontal neighbours.
struct MapQuality {
    double covered = 0, filled = 0, angle = 0;
};

MapQuality quality_of(const SurfaceMap& model, const Image<float>& depth) {
    double measured = 0, covered = 0, filled = 0;
    std::vector<float> angles;
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            const bool near = depth(x, y) > 0 && depth(x, y) < 4;
            measured += near;
            covered += near && model.has_surface(x, y);
            filled += depth(x, y) == 0 && model.has_surface(x, y);
            if (x == 0 || !model.has_surface(x, y) || !model.has_surface(x - 1, y)) continue;
            const float cosine = glm::dot(model.normal(x, y), model.normal(x - 1, y));
            angles.push_back(glm::degrees(std::acos(std::clamp(cosine, -1.0f, 1.0f))));
        }
    }
    if (angles.empty() || measured == 0) return {};
    const auto middle = angles.begin() + std::ptrdiff_t(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    return {covered / measured, filled / double(depth.pixels.size()), double(*middle)};
}

void time_stages(const VoxelVolume& model_volume, const Pose& pose, const RgbdFrame& frame,
                 const SlamSettings& settings) {
    const Image<float> clean = clean_depth(frame.depth, settings.depth);
    const Image<float> smooth = smooth_depth(clean, settings.depth);
    SurfaceMap surface = surface_from_depth(smooth, frame.lens, pose, settings.depth);
    std::vector<SurfaceMap> pyramid;
    for (const DepthLevel& level :
         depth_pyramid(smooth, frame.lens, settings.track.levels, settings.depth))
        pyramid.push_back(surface_from_depth(level.depth, level.lens, Pose{}, settings.depth));
    const SurfaceMap model = raycast_volume(model_volume, frame.lens, pose, settings.raycast);
    VoxelVolume volume = model_volume;
    std::printf("stages on the last frame at full size, ms of processor time:\n");
    time_stage("clean_depth", [&] { clean_depth(frame.depth, settings.depth); });
    time_stage("smooth_depth", [&] { smooth_depth(clean, settings.depth); });
    time_stage("surface_from_depth",
               [&] { surface_from_depth(smooth, frame.lens, pose, settings.depth); });
    time_stage("track_frame",
               [&] { track_frame(pyramid, model, std::vector<Pose>{pose}, settings.track); });
    time_stage("fuse_surface", [&] {
        fuse_surface(volume, surface, {frame.color, frame.lens, Pose{}}, settings.fusion);
    });
    time_stage("raycast_volume",
               [&] { raycast_volume(model_volume, frame.lens, pose, settings.raycast); });
    time_stage("extract_mesh", [&] { extract_mesh(model_volume); });
}

int run(int count, char** arguments) {
    keep_freed_memory();
    const Recording recording = open_recording(arguments[1]);
    const int most = count > 2 ? std::atoi(arguments[2]) : int(recording.info.frames.size());
    const bool fast = count > 3 && std::string(arguments[3]) == "fast";
    const SlamSettings settings = fast ? fast_slam() : accurate_slam();
    double decoding = 0;
    RgbdFrame frame;
    FrameSource source{recording.info.frames, recording.info.times, [&](int i) {
                           const double before = cpu_ms();
                           frame = recording.load(recording.info.frames[std::size_t(i)]);
                           decoding += cpu_ms() - before;
                           return frame;
                       }};
    source.numbers.resize(std::size_t(std::min(most, source.count())));
    const double before = cpu_ms();
    const Reconstruction result =
        reconstruct_recording(source, settings, PoseSource::tracked, [](int) { return true; });
    const double spent = cpu_ms() - before - decoding;
    const double peak = peak_mb();
    Trajectory poses;
    int lost = 0, judged = 0;
    double covered = 0, filled = 0, angle = 0;
    for (int i = 0; i < source.count(); ++i) {
        const ReconstructedFrame& f = result.frames[std::size_t(i)];
        lost += f.tracking.status == TrackingStatus::lost;
        poses.poses.push_back(
            {std::int64_t(std::llround(f.time * 1e9)), {f.tracking.world_from_camera, ""}});
        if (i < 20 || i > 60 || i % 5 != 0) continue;
        const Image<float> depth = source.load(i).depth;
        const MapQuality q =
            quality_of(raycast_volume(result.volume, frame.lens, f.tracking.world_from_camera,
                                      settings.raycast),
                       depth);
        covered += q.covered, filled += q.filled, angle += q.angle;
        ++judged;
    }
    std::printf("%d frames, %d lost: %.1f ms of processor time a frame, %zu bricks, peak %.0f MB\n",
                source.count(), lost, spent / source.count(), result.volume.bricks.size(), peak);
    std::printf("%zu keyframes, %zu loops\n", result.keyframes.size(), result.loops.size());
    if (judged > 0)
        std::printf("frames 20 to 60: %.2f %% covered, %.2f %% filled, normals %.2f degrees\n",
                    100 * covered / judged, 100 * filled / judged, angle / judged);
    if (!result.frames.empty())
        time_stages(result.volume, result.frames.back().tracking.world_from_camera, frame,
                    settings);
    if (count > 4) write_tum_trajectory(arguments[4], poses);
    return 0;
}

}  // namespace
}  // namespace inlay

int main(int count, char** arguments) {
    if (count < 2) {
        std::fprintf(stderr, "usage: bench_slam RECORDING [FRAMES] [fast|accurate] [POSES.txt]\n");
        return 2;
    }
    try {
        return inlay::run(count, arguments);
    } catch (const inlay::Error& error) {
        std::fprintf(stderr, "bench_slam: %s\n", error.what());
        return int(error.code());
    }
}
