#include "slam/depth/smooth_normals.h"
#include "slam/mapping/color_camera.h"
#include "slam/mapping/observe_frame.h"
#include "slam/mapping/see_model.h"
#include "slam/mesh/extract_mesh.h"

#include "apps/bench/frame_stages.h"
#include "apps/bench/stage_limits.h"
#include <benchmark/benchmark.h>

#include <memory>
#include <span>

namespace inlay {
namespace {

Stage extraction(const Subject& s) {
    Traffic voxels;
    for (const Brick& brick : s.volume().bricks)
        voxels.reads(std::span<const float>(brick.distance));
    const auto extract = [&s] { benchmark::DoNotOptimize(extract_mesh(s.volume())); };
    return {.name = "extract model",
            .body = extract,
            .limits = {{"every voxel once", {"bytes", bytes_of(voxels)}, streaming(voxels)}}};
}

Stage building(const Subject& s) {
    const std::shared_ptr<const TriangleMesh> mesh = s.model().parts().at(0).mesh;
    const auto build = [mesh, cache = std::make_shared<EmbreeSceneCache>()] {
        benchmark::DoNotOptimize(cache->place(mesh));
    };
    const auto build_quickly = [&s] { BareScene({&s.model()}, RTC_BUILD_QUALITY_LOW); };
    const Amount triangles{"triangles", double(mesh->triangles.size())};
    return {.name = "build over model",
            .body = build,
            .limits = {{"Embree at low quality", triangles, build_quickly}}};
}

Stage raycast(const Subject& s) {
    const auto cast = [&s] {
        benchmark::DoNotOptimize(raycast_volume(s.volume(), s.seen.lens, s.seen.world_from_camera,
                                                s.settings().slam.raycast));
    };
    const auto rays = std::make_shared<const BareRays>(
        pixel_rays(s.seen.lens, s.seen.world_from_camera, s.settings().slam.raycast.nearest));
    const auto scene = std::make_shared<const BareScene>(std::vector{&s.model()});
    const auto trace = [rays, scene] { benchmark::DoNotOptimize(trace_bare(*scene, *rays)); };
    return {.name = "raycast",
            .body = cast,
            .limits = {{"Embree on the model", {"rays", double(rays->rays)}, trace}}};
}

/// What goes over a surface map, and what it reads beside it.
template <class Pixel>
Limit map_once(const SurfaceMap& map, const Image<Pixel>& beside) {
    Traffic traffic;
    traffic.reads(beside);
    traffic.reads(map.position), traffic.reads(map.normal), traffic.reads(map.confidence);
    traffic.writes(map.position), traffic.writes(map.normal), traffic.writes(map.confidence);
    return bytes_once(traffic);
}

Stage completion(const Subject& s) {
    const auto complete = [&s] {
        const SlamSettings& slam = s.settings().slam;
        const SurfaceMap own = own_surface(s.frame, s.seen.world_from_camera, slam.depth);
        benchmark::DoNotOptimize(completed(s.seen, own, slam.raycast));
    };
    return {"complete by depth", complete, {map_once(s.seen, s.frame.depth)}};
}

Stage edges(const Subject& s) {
    const auto follow = [&s] {
        SurfaceMap map = s.seen;
        follow_photograph(map, s.frame.color, s.settings().slam.edges);
        benchmark::DoNotOptimize(map);
    };
    return {"edges", follow, {map_once(s.seen, s.frame.color)}};
}

Stage normals(const Subject& s) {
    Traffic traffic;
    traffic.reads(s.seen.position), traffic.reads(s.seen.normal), traffic.reads(s.seen.confidence);
    traffic.writes(s.seen.normal);
    const auto smooth = [&s] { benchmark::DoNotOptimize(smooth_normals(s.seen)); };
    return {"normals", smooth, {bytes_once(traffic)}};
}

}  // namespace

std::vector<Stage> surface_stages(const Subject& subject) {
    std::vector<Stage> stages{extraction(subject), building(subject), raycast(subject)};
    if (!color_is_apart(*subject.session.known)) stages.push_back(completion(subject));
    stages.push_back(edges(subject));
    stages.push_back(normals(subject));
    return stages;
}

}  // namespace inlay
