// The screen tracer against closed forms, and the hierarchical walk against the exhaustive one.
#include "render/trace/screen_tracer.h"

#include "recordings/base/check.h"
#include "render/trace/map_primary.h"
#include "tests/support/screen_scenes.h"

#include <gtest/gtest.h>

#include <vector>

namespace inlay {
namespace {

using test::Room;

/// Surfaces of thickness 0: only what lies exactly on a ray stops it.
ScreenTracerSettings thin() {
    ScreenTracerSettings settings;
    settings.thickness = settings.thickness_per_depth = 0;
    return settings;
}

ScreenTracerSettings thick(float metres) {
    ScreenTracerSettings settings = thin();
    settings.thickness = metres;
    return settings;
}

/// A map of nothing but a piece of the plane z = `depth` over the pixels low..high.
SurfaceMap plate(const Lens& lens, glm::ivec2 low, glm::ivec2 high, double depth) {
    SurfaceMap map = empty_surface_map(lens, Pose{});
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            map.position(x, y) = glm::vec3(depth * unproject(lens, {x, y}));
            map.normal(x, y) = {0, 0, -1};
        }
    }
    return map;
}

void expect_same(const ScreenHit& a, const ScreenHit& b, std::uint32_t number) {
    ASSERT_EQ(int(a.status), int(b.status)) << "ray " << number;
    ASSERT_EQ(a.pixel, b.pixel) << "ray " << number;
    ASSERT_EQ(a.distance, b.distance) << "ray " << number;
}

TEST(ScreenTracer, HierarchicalWalkFindsWhatTestingEveryPixelFinds) {
    for (const glm::ivec2 size : {glm::ivec2(160, 120), glm::ivec2(97, 53)}) {
        for (const double holes : {0.0, 0.05, 0.6}) {
            const SurfaceMap map =
                test::map_of(test::table_room(), test::room_lens(size.x, size.y), holes);
            const DepthPyramid pyramid = make_depth_pyramid(map, {});
            for (std::uint32_t i = 0; i < 5000; ++i) {
                const CameraRay ray =
                    i % 2 ? test::ray_from_anywhere(i) : test::ray_from_surface(map, i, 1e-3);
                if (!test::is_ray(ray)) continue;
                expect_same(trace_screen(pyramid, ray), trace_screen_exhaustively(pyramid, ray), i);
            }
        }
    }
}

TEST(ScreenTracer, HitsOnAPlaneAreWhereTheRayMeetsIt) {
    Room room;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.4, -0.8));
    room.planes = {{normal, glm::dot(normal, glm::dvec3(0, 0, 2))}};
    const DepthPyramid pyramid =
        make_depth_pyramid(test::map_of(room, test::room_lens(160, 120)), thin());
    int hits = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const CameraRay ray = test::ray_from_anywhere(i);
        const ScreenHit hit = trace_screen(pyramid, ray);
        const double before = glm::dot(normal, ray.origin) - room.planes[0].offset;
        if (hit.status != ScreenStatus::hit) continue;
        ++hits;
        const double approach = -glm::dot(normal, ray.direction);
        // The facet is in float (1e-7 of 2..10 m), which a flat ray stretches by 1 / cosine.
        // Between pixels, planes differ by such a rounding too, so a ray may slip to the next
        // pixel's edge.
        EXPECT_NEAR(hit.distance, before / approach, 1e-5 / std::abs(approach)) << "ray " << i;
    }
    EXPECT_GT(hits, 1000);
}

TEST(ScreenTracer, APlaneDoesNotShadowItself) {
    for (const double tilt : {0.0, 0.4, 0.8, 1.1, 1.3}) {  // rad between plane and image
        Room room;
        const glm::dvec3 normal{0, -std::sin(tilt), -std::cos(tilt)};
        room.planes = {{normal, -0.7}};
        const Lens lens = test::room_lens(160, 120);
        const SurfaceMap map = test::map_of(room, lens);
        const DepthPyramid pyramid = make_depth_pyramid(map, {});
        for (std::uint32_t i = 0; i < 4000; ++i) {
            const CameraRay ray = test::ray_from_surface(map, i, 0);
            if (!test::is_ray(ray) || ray.origin.z > 5) continue;  // beyond, facets are cut flat
            // From a point anywhere in the pixel, as camera rays find it, 0.1 mm off: float
            // positions (1e-7 of 5 m) under the flattest of these views.
            const glm::dvec2 in_pixel =
                project(lens, ray.origin) +
                glm::dvec2(uniform({3, 0, i, 0}, 0), uniform({3, 0, i, 0}, 1)) - 0.5;
            RayPacket camera;
            const glm::dvec3 view = glm::normalize(unproject(lens, in_pixel));
            camera.set(0, glm::vec3(0), glm::vec3(view));
            std::array<glm::ivec2, packet_width> pixels{};
            pixels[0] = glm::ivec2(glm::round(project(lens, ray.origin)));
            const RealPrimaryHit start = map_primary(map, camera, pixels).pixel[0];
            EXPECT_NEAR(glm::dot(normal, glm::dvec3(start.position)), -0.7, 1e-5);
            const ScreenHit hit =
                trace_screen(pyramid, {glm::dvec3(start.position) + 1e-4 * normal, ray.direction});
            EXPECT_NE(int(hit.status), int(ScreenStatus::hit)) << "tilt " << tilt << " ray " << i;
        }
    }
}

TEST(ScreenTracer, NoPixelIsSteppedOver) {
    const Lens lens = test::room_lens(131, 77);
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const SampleKey key{5, 0, i, 0};
        const glm::ivec2 pixel{int(uniform(key, 0) * 131), int(uniform(key, 1) * 77)};
        const double depth = 0.5 + 3 * uniform(key, 2);
        const DepthPyramid pyramid = make_depth_pyramid(plate(lens, pixel, pixel, depth), thin());
        const glm::dvec2 inside =
            glm::dvec2(pixel) + 0.98 * (glm::dvec2(uniform(key, 3), uniform(key, 4)) - 0.5);
        const glm::dvec3 target = depth * unproject(lens, inside);
        const glm::dvec3 origin{2 * uniform(key, 5) - 1, 2 * uniform(key, 6) - 1,
                                depth * (2 * uniform(key, 7) - 0.5)};  // before or behind it
        if (std::abs(origin.z - depth) < 0.05) continue;
        const double distance = glm::length(target - origin);
        const ScreenHit hit = trace_screen(pyramid, {origin, (target - origin) / distance});
        ASSERT_EQ(int(hit.status), int(ScreenStatus::hit)) << "plate " << i;
        EXPECT_EQ(hit.pixel, pixel);
        EXPECT_NEAR(hit.distance, distance, 1e-4);  // float facet, 1e-7 m, stretched by 1 / cosine
        EXPECT_LT(glm::length(hit.position - target), 1e-4);
    }
}

TEST(ScreenTracer, RaysAlongTheLineOfSightAreExact) {
    const Lens lens = test::room_lens(160, 120);
    const DepthPyramid pyramid = make_depth_pyramid(plate(lens, {0, 0}, {159, 119}, 2.0), {});
    for (const glm::dvec2 at : {glm::dvec2(0, 0), glm::dvec2(79.5, 59.5), glm::dvec2(31.25, 100)}) {
        const glm::dvec3 view = glm::normalize(unproject(lens, at));
        const ScreenHit away = trace_screen(pyramid, {1.0 / view.z * view, view});
        ASSERT_EQ(int(away.status), int(ScreenStatus::hit));
        EXPECT_NEAR(away.distance, 1 / view.z, 1e-6);  // float depth of 2 m
        EXPECT_EQ(int(trace_screen(pyramid, {1.0 / view.z * view, -view}).status),
                  int(ScreenStatus::off_screen));
    }
}

TEST(ScreenTracer, RaysParallelToTheImageMeetAStepSideways) {
    const Lens lens = test::room_lens(160, 120);
    SurfaceMap map = plate(lens, {100, 0}, {159, 119}, 1.0);
    const DepthPyramid pyramid = make_depth_pyramid(map, thick(0.5f));
    const ScreenHit hit = trace_screen(pyramid, {{-0.2, 0.0, 1.1}, {1, 0, 0}});
    ASSERT_EQ(int(hit.status), int(ScreenStatus::hit));
    EXPECT_EQ(hit.pixel.x, 100);
    EXPECT_NEAR(hit.position.x, 1.1 * (99.5 - lens.cx) / lens.fx, 1e-9);  // the pixel's edge
    EXPECT_EQ(int(trace_screen(pyramid, {{-0.2, 0.0, 0.9}, {1, 0, 0}}).status),
              int(ScreenStatus::off_screen));
}

TEST(ScreenTracer, RaysPassBehindWhatIsThinnerThanTheGap) {
    const Lens lens = test::room_lens(160, 120);
    const SurfaceMap map = plate(lens, {60, 40}, {99, 79}, 1.0);
    const CameraRay behind{{-1, 0, 1.5}, {1, 0, 0}};
    EXPECT_EQ(int(trace_screen(make_depth_pyramid(map, thick(0.3f)), behind).status),
              int(ScreenStatus::off_screen));
    EXPECT_EQ(int(trace_screen(make_depth_pyramid(map, thick(0.7f)), behind).status),
              int(ScreenStatus::hit));
}

TEST(ScreenTracer, SlabsAreAsThickAlongTheirNormalAsTheSettingsSay) {
    Room room;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0, -0.5, -0.8));
    room.planes = {{normal, -1.0}};
    const Lens lens = test::room_lens(160, 120);
    const SurfaceMap map = test::map_of(room, lens);
    const DepthPyramid pyramid = make_depth_pyramid(map, thick(0.1f));
    const glm::dvec3 on_plane(map.position(80, 60));
    const glm::dvec3 along = glm::normalize(glm::cross(normal, glm::dvec3(0, 1, 0)));
    for (const double depth : {0.05, 0.099, 0.101, 0.2}) {  // m behind the front
        // It starts inside its own pixel, so what stops it is the next one.
        const ScreenHit hit = trace_screen(pyramid, {on_plane - depth * normal, along});
        EXPECT_EQ(hit.status == ScreenStatus::hit, depth < 0.1) << depth;
    }
}

TEST(ScreenTracer, HolesNeverStopARay) {
    const Lens lens = test::room_lens(64, 48);
    const DepthPyramid pyramid = make_depth_pyramid(empty_surface_map(lens, Pose{}), thick(10));
    for (std::uint32_t i = 0; i < 1000; ++i)
        EXPECT_NE(int(trace_screen(pyramid, test::ray_from_anywhere(i)).status),
                  int(ScreenStatus::hit));
}

TEST(ScreenTracer, RaysThatLeaveTheImageSaySo) {
    const Lens lens = test::room_lens(64, 48);
    const DepthPyramid pyramid = make_depth_pyramid(plate(lens, {0, 0}, {3, 3}, 1.0), {});
    const auto status = [&](const glm::dvec3& o, const glm::dvec3& d) {
        return trace_screen(pyramid, {o, glm::normalize(d)}).status;
    };
    EXPECT_EQ(status({0, 0, 2}, {0, 0, 1}), ScreenStatus::missed);
    EXPECT_EQ(status({0, 0, 2}, {0.1, 0.1, 1}), ScreenStatus::missed);
    EXPECT_EQ(status({0, 0, 2}, {1, 0, 0}), ScreenStatus::off_screen);
    EXPECT_EQ(status({0, 0, 2}, {0.1, 0, -1}), ScreenStatus::off_screen);
    EXPECT_EQ(status({0, 0, -1}, {0, 0, -1}), ScreenStatus::off_screen);
    EXPECT_EQ(status({0, 0, -1}, {0, 0, 1}), ScreenStatus::missed);
    EXPECT_EQ(status({9, 0, 1}, {1, 0, 0}), ScreenStatus::off_screen);
}

TEST(ScreenTracer, AHitCountsOnlyBeyondTMin) {
    const Lens lens = test::room_lens(64, 48);
    const DepthPyramid pyramid = make_depth_pyramid(plate(lens, {0, 0}, {63, 47}, 2.0), thin());
    EXPECT_EQ(trace_screen(pyramid, {{0, 0, 1}, {0, 0, 1}, 0.9}).status, ScreenStatus::hit);
    EXPECT_EQ(trace_screen(pyramid, {{0, 0, 1}, {0, 0, 1}, 1.1}).status, ScreenStatus::missed);
}

TEST(ScreenTracer, RefusesDistortedLensesAndImpossibleSettings) {
    const Lens lens = test::room_lens(8, 6);
    SurfaceMap map = empty_surface_map(lens, Pose{});
    map.lens.k1 = 0.01;
    EXPECT_THROW(make_depth_pyramid(map, {}), Error);
    map.lens = test::room_lens(9, 6);
    EXPECT_THROW(make_depth_pyramid(map, {}), Error);
    EXPECT_THROW(validate(thick(-1)), Error);
    EXPECT_NO_THROW(validate(ScreenTracerSettings{}));
}

}  // namespace
}  // namespace inlay
