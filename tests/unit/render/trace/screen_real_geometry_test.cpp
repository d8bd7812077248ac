// Screen-traced real geometry as the sampler sees it: packets of world rays.
#include "render/trace/screen_real_geometry.h"

#include "recordings/base/check.h"
#include "render/trace/screen_tracer.h"
#include "tests/support/screen_scenes.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

struct Seen {
    SurfaceMap map;
    Image<Rgb> photo;
    std::shared_ptr<const DepthPyramid> pyramid;
};

/// The table's room from a camera that stands anywhere; every pixel of the photograph differs.
Seen room_from_a_turned_camera() {
    Seen seen{
        test::map_of(test::table_room(), test::room_lens(160, 120)), Image<Rgb>(160, 120), {}};
    seen.map.world_from_camera = {
        glm::mat3_cast(glm::angleAxis(2.1, glm::normalize(glm::dvec3(1, -2, 0.5)))),
        {3.0, -2.0, 0.7}};
    for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
            seen.photo(x, y) = Rgb(float(x), float(y), 1);
    seen.pyramid = std::make_shared<DepthPyramid>(make_depth_pyramid(seen.map, {}));
    return seen;
}

TEST(ScreenRealGeometry, PacketsInTheWorldMeetWhatSingleRaysOfTheCameraMeet) {
    const Seen seen = room_from_a_turned_camera();
    const Pose& world_from_camera = seen.map.world_from_camera;
    const auto counts = std::make_shared<ScreenRayCounts>();
    const RealGeometry real =
        screen_real_geometry({seen.map, seen.photo}, seen.pyramid, {}, counts);
    std::uint64_t traced = 0, hits = 0;
    for (std::uint32_t packet = 0; packet < 200; ++packet) {
        RayPacket rays;
        std::array<CameraRay, packet_width> in_camera;
        for (int lane = 0; lane < packet_width; lane += lane % 3 + 1) {  // with gaps
            CameraRay& ray = in_camera[std::size_t(lane)];
            ray = test::ray_from_surface(seen.map, packet * 16 + std::uint32_t(lane), 0.01);
            rays.set(lane, glm::vec3(world_from_camera * ray.origin),
                     glm::vec3(world_from_camera.rotation * ray.direction));
            ++traced;
        }
        const DistancePacket distances = real.distances(rays);
        const RealHits back = real.radiances(rays, {});
        for (int lane = 0; lane < packet_width; ++lane) {
            const auto i = std::size_t(lane);
            EXPECT_EQ(distances[i], back.distance[i]);
            if (!rays.has(lane)) {
                EXPECT_EQ(distances[i], no_hit);
                continue;
            }
            const CameraRay rounded{
                seen.pyramid->camera_from_world * glm::dvec3(rays.origin[i]),
                seen.pyramid->camera_from_world.rotation * glm::dvec3(rays.direction[i])};
            const ScreenHit hit = trace_screen(*seen.pyramid, rounded);
            if (hit.status != ScreenStatus::hit) {
                EXPECT_EQ(distances[i], no_hit);
                continue;
            }
            ++hits;
            EXPECT_EQ(distances[i], float(hit.distance));
            EXPECT_EQ(back.radiance[i], seen.photo(hit.pixel.x, hit.pixel.y));
            // The place it hits is seen at that pixel: float world coordinates of 4 m, 1e-4 px.
            const glm::dvec2 at = project(seen.map.lens, hit.position);
            EXPECT_LE(std::abs(at.x - hit.pixel.x), 0.5 + 1e-4);
            EXPECT_LE(std::abs(at.y - hit.pixel.y), 0.5 + 1e-4);
        }
    }
    EXPECT_GT(hits, 100U);
    EXPECT_EQ(counts->hit, 2 * hits);  // distances and radiances
    EXPECT_EQ(counts->hit + counts->missed + counts->off_screen, 2 * traced);
}

TEST(ScreenRealGeometry, PrimaryHitsLieOnTheSurfaceSeen) {
    const Seen seen = room_from_a_turned_camera();
    const Pose& world_from_camera = seen.map.world_from_camera;
    const RealGeometry real = screen_real_geometry({seen.map, seen.photo}, seen.pyramid, {});
    const test::Room room = test::table_room();
    for (int x = 0; x < 160; x += 16) {
        RayPacket rays;
        std::array<glm::ivec2, packet_width> pixels{};
        for (int lane = 0; lane < packet_width; ++lane) {
            pixels[std::size_t(lane)] = {x, 7 * lane};
            const glm::dvec2 at = glm::dvec2(x, 7 * lane) + glm::dvec2(0.4, -0.3);
            rays.set(lane, glm::vec3(world_from_camera.translation),
                     glm::vec3(world_from_camera.rotation *
                               glm::normalize(unproject(seen.map.lens, at))));
        }
        const auto hits = real.primary(rays, pixels).pixel;
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (!seen.map.has_surface(pixels[i].x, pixels[i].y)) {
                EXPECT_EQ(hits[i].distance, no_hit);
                continue;
            }
            const glm::dvec3 p = inverse(world_from_camera) * glm::dvec3(hits[i].position);
            const glm::dvec3 n(seen.map.normal(pixels[i].x, pixels[i].y));
            const glm::dvec3 centre(seen.map.position(pixels[i].x, pixels[i].y));
            EXPECT_LT(std::abs(glm::dot(n, p - centre)), 1e-5);  // float world coordinates of 4 m
            EXPECT_NEAR(hits[i].distance, glm::length(p), 1e-5);
        }
    }
}

TEST(ScreenRealGeometry, RefusesAPhotographOfAnotherSize) {
    const Seen seen = room_from_a_turned_camera();
    const Image<Rgb> smaller(80, 60);
    EXPECT_THROW(screen_real_geometry({seen.map, smaller}, seen.pyramid, {}), Error);
}

}  // namespace
}  // namespace inlay
