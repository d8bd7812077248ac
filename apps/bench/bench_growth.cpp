// How the cost of a frame grows with resolution, samples, triangles, objects and the share of the
// image that they change: times, and the exponent that fits them.
//
//   bench_growth [RECORDING FRAME SCENE]
#include "composite/accuracy/cost.h"
#include "composite/accuracy/work.h"
#include "composite/session/obey_plan.h"
#include "composite/session/real_scene.h"
#include "composite/session/stop_watch.h"
#include "recordings/base/check.h"
#include "recordings/base/keep_memory.h"
#include "render/filter/filter_layers.h"
#include "slam/volume/raycast_volume.h"

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

namespace inlay {
namespace {

/// A tracked frame that can be seen at any resolution.
struct Subject {
    Settings settings;
    Work work;
    SlamState slam;
    TracedModel model;
    RgbdFrame frame;
    SurfaceMap surface;
};

Subject open_subject(const std::filesystem::path& folder, int number,
                     const std::filesystem::path& scene) {
    Subject s;
    s.work = open_work(folder, s.settings, scene);
    s.slam = start_slam(s.settings.slam);
    int seen = 0;
    for (const int n : s.work.recording->info.frames) {
        s.frame = s.work.recording->load(n);
        s.surface = track_frame_of(s.slam, s.frame, s.settings).surface;
        update_model(s.model, s.slam.volume, seen++, s.settings.geometry);
        if (n >= number) break;
    }
    return s;
}

/// The frame as a camera with `scale` times the pixels each way would have taken it.
struct View {
    RealScene real;
    Photo photo;
};

View seen_at(const Subject& s, double scale) {
    const Lens& from = s.frame.lens;
    Lens lens = from;
    lens.width = int(std::lround(scale * from.width));
    lens.height = int(std::lround(scale * from.height));
    lens.fx *= scale, lens.fy *= scale;
    lens.cx = (lens.cx + 0.5) * scale - 0.5, lens.cy = (lens.cy + 0.5) * scale - 0.5;
    Image<EncodedRgb> color(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x)
            color(x, y) = s.frame.color(std::min(int(x / scale), from.width - 1),
                                        std::min(int(y / scale), from.height - 1));
    View view;
    view.photo = linearise(std::move(color));
    view.real = describe_real_scene(
        raycast_volume(s.slam.volume, lens, s.surface.world_from_camera, s.settings.slam.raycast),
        view.photo.linear, s.slam.volume, s.model, s.settings);
    return view;
}

struct Measured {
    double ms = 0;          // tracing, filter and composite; the best of three
    double influenced = 0;  // share of the pixels
};

Measured measure(const Subject& s, const View& view, const VirtualScene& objects, int samples) {
    EmbreeSceneCache cache;
    const EmbreeScene placed = cache.place(objects, s.frame.time, /*real=*/false);
    const SurfaceMap& surface = *view.real.surface;
    const SamplingSettings sampling = with_samples(s.settings.trace, samples);
    Measured result{1e300, 0};
    for (int repeat = 0; repeat < 3; ++repeat) {
        StopWatch watch;
        const TwoModeResult sampled =
            sample_two_modes({surface.lens, surface.world_from_camera, view.real.geometry, placed,
                              s.work.environment},
                             sampling, std::uint32_t(s.frame.index));
        const Layers layers =
            filter_layers(sampled.layers, nullptr, s.work.environment_bandwidth, s.settings.filter);
        const Composite out = composite(view.photo, layers, s.settings.blend);
        result.ms = std::min(result.ms, watch.lap());
        result.influenced = double(out.influenced_pixels) / double(out.linear.pixels.size());
    }
    return result;
}

/// Where a pixel's surface is, and a little above it.
glm::dvec3 above(const Subject& s, glm::dvec2 share_of_image, double height) {
    glm::ivec2 p(share_of_image * glm::dvec2(s.surface.lens.width, s.surface.lens.height));
    const int towards_middle = p.x < s.surface.lens.width / 2 ? 1 : -1;
    while (!s.surface.has_surface(p.x, p.y)) {  // the depth image may have a hole there
        p.x += towards_middle;
        if (p.x <= 0 || p.x >= s.surface.lens.width - 1)
            throw Error(ExitCode::bad_data, "no surface in a row of the frame; take another");
    }
    const glm::dvec3 n =
        s.surface.world_from_camera.rotation * glm::dvec3(s.surface.normal(p.x, p.y));
    return s.surface.world_from_camera * glm::dvec3(s.surface.position(p.x, p.y)) + height * n;
}

SceneObject ball(const Subject& s, glm::dvec2 share_of_image, float radius) {
    SceneObject object;
    object.parts.push_back({SphereShape{radius}, Diffuse{Rgb(0.4f)}});
    object.motion.push_back(
        {0.0, glm::translate(glm::dmat4(1), above(s, share_of_image, double(radius)))});
    return object;
}

/// Balls in rows over the lower part of the image.
VirtualScene many_balls(const Subject& s, int count) {
    VirtualScene scene;
    const int across = int(std::ceil(std::sqrt(2.0 * count)));
    for (int i = 0; i < count; ++i)
        scene.objects.push_back(ball(
            s,
            {0.15 + 0.7 * (i % across + 0.5) / across, 0.5 + 0.4 * (i / across + 0.5) * 2 / across},
            0.01f));
    return scene;
}

/// A ball of about `count` triangles.
VirtualScene fine_ball(const Subject& s, int count) {
    const int rings = std::max(3, int(std::sqrt(count / 4.0))), sectors = 2 * rings;
    auto mesh = std::make_shared<TriangleMesh>();
    for (int r = 0; r <= rings; ++r)
        for (int k = 0; k < sectors; ++k) {
            const double down = glm::pi<double>() * r / rings,
                         around = 2 * glm::pi<double>() * k / sectors;
            mesh->positions.emplace_back(0.05 * std::sin(down) * std::cos(around),
                                         0.05 * std::cos(down),
                                         0.05 * std::sin(down) * std::sin(around));
        }
    const auto at = [sectors](int r, int k) { return std::uint32_t(r * sectors + k % sectors); };
    for (int r = 0; r < rings; ++r)
        for (int k = 0; k < sectors; ++k) {
            mesh->triangles.push_back({at(r, k), at(r + 1, k), at(r + 1, k + 1)});
            mesh->triangles.push_back({at(r, k), at(r + 1, k + 1), at(r, k + 1)});
        }
    VirtualScene scene{{ball(s, {0.4, 0.65}, 0.05f)}};
    scene.objects[0].parts[0].shape = MeshShape{std::move(mesh)};
    return scene;
}

struct Point {
    std::string name;
    double x = 0;
    Measured measured;
};

/// Slope of log ms over log x.
double fitted_exponent(const std::vector<Point>& points) {
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (const Point& p : points) {
        if (!(p.x > 0)) continue;
        const double x = std::log(p.x), y = std::log(p.measured.ms);
        n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void print(const char* title, const std::vector<Point>& points) {
    std::printf("%s: exponent %.2f\n", title, fitted_exponent(points));
    for (const Point& p : points)
        std::printf("  %12s %10.1f ms  %5.1f %% influenced\n", p.name.c_str(), p.measured.ms,
                    100 * p.measured.influenced);
    std::fflush(stdout);
}

int run(const std::vector<std::string>& words) {
    keep_freed_memory();
    const bool named = words.size() == 3;
    const Subject s =
        open_subject(named ? words[0] : INLAY_DEMO_RECORDING, named ? std::stoi(words[1]) : 10,
                     named ? words[2] : INLAY_DEMO_SCENE);
    const int samples = s.settings.trace.primary * s.settings.trace.secondary;
    const View view = seen_at(s, 1);
    std::vector<Point> points;
    for (const int width : {160, 320, 640, 1280, 1920}) {
        const View scaled = seen_at(s, double(width) / s.frame.lens.width);
        const Lens& lens = scaled.real.surface->lens;
        points.push_back({std::to_string(lens.width) + "x" + std::to_string(lens.height),
                          double(lens.width) * lens.height,
                          measure(s, scaled, s.work.scene, samples)});
    }
    print("pixels", points);
    points.clear();
    for (const int n : {4, 16, 64, 256})
        points.push_back({std::to_string(n), double(n), measure(s, view, s.work.scene, n)});
    print("samples per pixel", points);
    points.clear();
    for (const int n : {1000, 10000, 100000, 1000000, 2000000})
        points.push_back(
            {std::to_string(n), double(n), measure(s, view, fine_ball(s, n), samples)});
    print("triangles", points);
    points.clear();
    for (const int n : {1, 5, 20, 50, 200})
        points.push_back(
            {std::to_string(n), double(n), measure(s, view, many_balls(s, n), samples)});
    print("objects", points);
    points.clear();
    for (const float radius : {0.001f, 0.003f, 0.01f, 0.03f, 0.1f, 0.3f}) {
        const Measured m = measure(s, view, {{ball(s, {0.4, 0.65}, radius)}}, samples);
        points.push_back({"r " + std::to_string(radius).substr(0, 5), m.influenced, m});
    }
    print("influenced share", points);
    std::printf("peak memory %.0f MB\n", peak_memory_mb());
    return EXIT_SUCCESS;
}

}  // namespace
}  // namespace inlay

int main(int argc, char** argv) { return inlay::run({argv + 1, argv + argc}); }
