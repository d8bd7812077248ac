// The screen tracer against the exhaustive search over many rays, against Embree on the
// triangulated map, and against the solids themselves.
#include "recordings/base/parallel.h"
#include "recordings/readers/recording.h"
#include "render/trace/real_geometry.h"
#include "render/trace/screen_tracer.h"
#include "slam/depth/surface_from_depth.h"
#include "tests/support/screen_scenes.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <numbers>
#include <vector>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::Room;

constexpr double pi = std::numbers::pi;
constexpr float off_surface = 5e-3f;  // m
constexpr int rays_per_point = 64;
constexpr float mesh_step = 0.05f;  // share of depth up to which neighbours are one surface

/// The table's room with two thin things: a pole of 2 cm and a shelf of 1 cm.
Room cluttered_room() {
    Room room = test::table_room();
    room.boxes.push_back({{0.55, -0.3, 0.9}, {0.57, 0.4, 0.92}});
    room.boxes.push_back({{-0.7, -0.2, 1.3}, {-0.4, -0.19, 1.6}});
    return room;
}

/// The first frame of the kitchen, cleaned and smoothed.
std::optional<SurfaceMap> kitchen_map() {
    const fs::path folder = fs::path(INLAY_DATA_DIR) / "recordings/kitchen";
    if (!fs::exists(folder)) return std::nullopt;
    const Recording recording = open_recording(folder);
    const RgbdFrame frame = recording.load(recording.info.frames.front());
    return surface_from_depth(filter_depth(frame.depth, {}), pinhole(frame.lens), Pose{});
}

/// Rays for which the walk and the exhaustive search differ in anything.
int disagreements(const SurfaceMap& map, int rays) {
    const DepthPyramid pyramid = make_depth_pyramid(map, {});
    return int(ordered_sum(rays, [&](int i) {
        const auto number = std::uint32_t(i);
        const CameraRay ray = i % 4 == 0 ? test::ray_from_anywhere(number)
                                         : test::ray_from_surface(map, number, off_surface);
        if (!test::is_ray(ray)) return 0.0;
        const ScreenHit a = trace_screen(pyramid, ray), b = trace_screen_exhaustively(pyramid, ray);
        return a.status == b.status && a.pixel == b.pixel && a.distance == b.distance ? 0.0 : 1.0;
    }));
}

TEST(ScreenAccuracy, WalkEqualsExhaustiveSearchForALargeNumberOfRays) {
    for (const double holes : {0.0, 0.05})
        EXPECT_EQ(
            disagreements(test::map_of(cluttered_room(), test::room_lens(320, 240), holes), 100000),
            0);
}

TEST(ScreenAccuracy, WalkEqualsExhaustiveSearchInAKitchen) {
    const auto map = kitchen_map();
    if (!map) GTEST_SKIP() << "no recordings/kitchen in " INLAY_DATA_DIR;
    EXPECT_EQ(disagreements(*map, 100000), 0);
}

/// Shares of hemisphere rays, and what they mean under a constant environment of radiance 1.
struct Comparison {
    double agreement = 0;                // rays on which both say the same
    double occluded = 0, reference = 0;  // rays that each finds blocked
    double let_through = 0;              // that only the reference blocks
    double mean_difference = 0;          // of the irradiance, over the points
    double rms_difference = 0;
};

/// `blocked(ray)` and `truly_blocked(ray)` over `points` random surface points.
template <class Blocked, class Truly>
Comparison compare(const SurfaceMap& map, int points, const Blocked& blocked, const Truly& truly) {
    Comparison sum;
    int count = 0;
    for (int p = 0; p < points; ++p) {
        const CameraRay start = test::ray_from_surface(map, std::uint32_t(p), off_surface);
        if (!test::is_ray(start)) continue;
        const glm::ivec2 pixel(glm::round(project(map.lens, start.origin)));
        if (!map.position.contains(pixel.x, pixel.y) || !map.has_surface(pixel.x, pixel.y))
            continue;
        const glm::mat3 basis = basis_about(map.normal(pixel.x, pixel.y));
        double a = 0, b = 0, same = 0, missed = 0;
        for (int r = 0; r < rays_per_point; ++r) {
            const SampleKey key{41, 0, std::uint32_t(p), std::uint32_t(r)};
            const glm::vec3 d = basis * sample_cosine_hemisphere(stratified_pair(key, 0)).direction;
            const CameraRay ray{start.origin, glm::dvec3(d)};
            const bool found = blocked(ray), truth = truly(ray);
            a += found;
            b += truth;
            same += found == truth;
            missed += truth && !found;
        }
        const double difference = pi * (b - a) / rays_per_point;
        sum.agreement += same / rays_per_point;
        sum.occluded += a / rays_per_point;
        sum.reference += b / rays_per_point;
        sum.let_through += missed / rays_per_point;
        sum.mean_difference += difference;
        sum.rms_difference += difference * difference;
        ++count;
    }
    return {sum.agreement / count,       sum.occluded / count,
            sum.reference / count,       sum.let_through / count,
            sum.mean_difference / count, std::sqrt(sum.rms_difference / count)};
}

void print(const std::string& what, const Comparison& c) {
    std::printf(
        "  %-40s agree %.4f, blocked %.4f, reference %.4f, let through %.4f, "
        "E mean %+.4f rms %.4f\n",
        what.c_str(), c.agreement, c.occluded, c.reference, c.let_through, c.mean_difference,
        c.rms_difference);
}

ScreenTracerSettings with_thickness(float metres) {
    ScreenTracerSettings settings;
    settings.thickness = metres;
    settings.thickness_per_depth = 0;
    return settings;
}

auto screen_blocks(const DepthPyramid& pyramid) {
    return [&pyramid](const CameraRay& ray) {
        return trace_screen(pyramid, ray).status == ScreenStatus::hit;
    };
}

auto mesh_blocks(const EmbreeScene& mesh) {
    return [&mesh](const CameraRay& ray) {
        RayPacket packet;
        packet.set(0, glm::vec3(ray.origin), glm::vec3(ray.direction));
        return (mesh.occluded(packet) & 1U) != 0;
    };
}

/// Blocked by a solid at a place within the image, where a surface map can know of it.
auto solid_blocks(const Room& room, const Lens& lens) {
    return [&room, lens](const CameraRay& ray) {
        const test::SolidHit hit = test::meet_room(room, ray.origin, ray.direction);
        if (!std::isfinite(hit.distance)) return false;
        const glm::dvec3 p = ray.origin + hit.distance * ray.direction;
        return p.z > 0 && nearest_pixel(lens, project(lens, p)).has_value();
    };
}

EmbreeScene mesh_of(EmbreeSceneCache& cache, const SurfaceMap& map) {
    const Image<Rgb> photo(map.lens.width, map.lens.height, Rgb(1));
    return cache.place(std::make_shared<TriangleMesh>(triangulate({map, photo}, mesh_step)));
}

TEST(ScreenAccuracy, ThinSurfacesAgreeWithTheTriangulatedMap) {
    EmbreeSceneCache cache;
    for (const int width : {160, 640}) {
        const SurfaceMap map =
            test::map_of(cluttered_room(), test::room_lens(width, width * 3 / 4));
        const EmbreeScene mesh = mesh_of(cache, map);
        const DepthPyramid pyramid = make_depth_pyramid(map, with_thickness(0));
        const Comparison c = compare(map, 2000, screen_blocks(pyramid), mesh_blocks(mesh));
        print(
            width == 160 ? "thickness 0 against mesh, 160 px" : "thickness 0 against mesh, 640 px",
            c);
        // Of the same surface, only outlines differ: triangles end half a pixel early, bridge steps
        // below 5 %, and miss flat views whose depth changes by more. That is a band of a pixel
        // about 8 % (640 px: 2 %) of the picture, of which a point's hemisphere sees a part.
        EXPECT_GT(c.agreement, width == 160 ? 0.97 : 0.99);
        EXPECT_LT(std::abs(c.mean_difference), width == 160 ? 0.08 : 0.02);
    }
}

TEST(ScreenAccuracy, ThicknessBringsOcclusionNearerToTheSolids) {
    const Room room = cluttered_room();
    const SurfaceMap map = test::map_of(room, test::room_lens(640, 480));
    const auto solid = solid_blocks(room, map.lens);
    EmbreeSceneCache cache;
    const EmbreeScene mesh = mesh_of(cache, map);
    print("mesh against solids", compare(map, 2000, mesh_blocks(mesh), solid));
    Comparison thin;
    for (const float thickness : {0.0f, 0.01f, 0.02f, 0.03f, 0.05f, 0.1f}) {
        const DepthPyramid pyramid = make_depth_pyramid(map, with_thickness(thickness));
        const Comparison c = compare(map, 2000, screen_blocks(pyramid), solid);
        if (thickness == 0) thin = c;
        print("against solids, thickness " + std::to_string(thickness), c);
    }
    const DepthPyramid pyramid = make_depth_pyramid(map, {});
    const Comparison c = compare(map, 2000, screen_blocks(pyramid), solid);
    print("default thickness against solids", c);
    // The back of things is not in the picture. What is left is 1 to 2 % of the rays, half of them
    // too many and half too few, so the mean stays within a share of pi.
    EXPECT_GT(c.agreement, 0.98);
    EXPECT_GT(c.agreement, thin.agreement);
    EXPECT_LT(std::abs(c.mean_difference), std::abs(thin.mean_difference) / 2);
    EXPECT_LT(std::abs(c.mean_difference), 0.01 * pi);
}

TEST(ScreenAccuracy, OcclusionInAKitchenIsThatOfItsMesh) {
    const auto map = kitchen_map();
    if (!map) GTEST_SKIP() << "no recordings/kitchen in " INLAY_DATA_DIR;
    EmbreeSceneCache cache;
    const EmbreeScene mesh = mesh_of(cache, *map);
    for (const float thickness : {0.0f, 0.01f, 0.03f, 0.05f}) {
        const DepthPyramid pyramid = make_depth_pyramid(*map, with_thickness(thickness));
        const Comparison c = compare(*map, 2000, screen_blocks(pyramid), mesh_blocks(mesh));
        print("kitchen against mesh, thickness " + std::to_string(thickness), c);
        if (thickness != 0.01f) continue;
        // 1 cm closes the cracks that noise opens between tangent planes (some mm at 2 m), so next
        // to nothing that the mesh stops gets through. What is stopped besides passes within 1 cm
        // (2 cm at flat views) behind outlines, where the mesh has no surface.
        EXPECT_LT(c.let_through, 0.005);
        EXPECT_GT(c.agreement, 0.96);
        EXPECT_LT(std::abs(c.mean_difference), 0.03 * pi);
    }
}

}  // namespace
}  // namespace inlay
