// The screen tracer on degenerate maps and rays: no invalid operation, nothing that is not finite,
// and still the answer of the exhaustive search.
#include "render/trace/screen_tracer.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/screen_scenes.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace inlay {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite = std::numeric_limits<float>::infinity();

/// Every pixel one of: nothing, not a number, infinite, far too near or far, normals that are
/// missing, turned away, seen edge-on or not finite, or a good surface.
SurfaceMap map_of_hard_cases(int width, int height) {
    const Lens lens = test::room_lens(width, height);
    SurfaceMap map = empty_surface_map(lens, Pose{});
    const std::vector<float> depths{0, nan, infinite, -1, 1e-30f, 1e30f, 1e-5f, 1, 1, 2, 3, 1e5f};
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const SampleKey key{21, 0, std::uint32_t(y * width + x), 0};
            const float depth = depths[std::size_t(uniform(key, 0) * float(depths.size()))];
            const glm::vec3 view(unproject(lens, {x, y}));
            const glm::vec3 across = glm::normalize(glm::cross(view, glm::vec3(0.3f, 1, 0)));
            const std::vector<glm::vec3> normals{
                glm::vec3(0), glm::vec3(nan), glm::vec3(infinite), glm::normalize(view),
                across,       -across,        {0, 0, -1},          -glm::normalize(view)};
            map.position(x, y) = depth * view;
            map.normal(x, y) = normals[std::size_t(uniform(key, 1) * float(normals.size()))];
        }
    }
    return map;
}

std::vector<CameraRay> hard_rays(const Lens& lens) {
    std::vector<glm::dvec3> origins{{0, 0, 0},      {0, 0, 1},      {0, 0, -1}, {0, 0, 1e-300},
                                    {1e-300, 0, 1}, {0, 0, 1e-12},  {5, 5, 0},  {1e6, -1e6, 1e6},
                                    {0.1, 0.2, 1},  {-0.2, 0.1, 3}, {0, 0, 2}};
    for (const double edge : {-0.5, 0.5, lens.width - 0.5})  // on pixel edges and corners
        origins.push_back(1.5 * unproject(lens, {edge, 0.5}));
    std::vector<glm::dvec3> directions{{1, 0, 0},      {-1, 0, 0},     {0, 1, 0},
                                       {0, -1, 0},     {0, 0, 1},      {0, 0, -1},
                                       {1, 0, 1e-300}, {1, 0, -1e-17}, {1e-300, 1e-300, 1},
                                       {1e-14, 0, -1}, {1, 1, 0},      {1, -1, 1e-9}};
    for (const double x : {-0.5, 0.0, 0.5, lens.width - 0.5})
        for (const double y : {-0.5, 0.0, 0.5, lens.height - 0.5})
            directions.push_back(glm::normalize(unproject(lens, {x, y})));
    std::vector<CameraRay> rays;
    for (const glm::dvec3& o : origins) {
        for (const glm::dvec3& d : directions) {
            for (const double t_min : {0.0, 1e-4, 10.0}) {
                rays.push_back({o, glm::normalize(d), t_min});
                rays.push_back({o, -glm::normalize(d), t_min});
            }
        }
    }
    return rays;
}

void expect_finite(const ScreenHit& hit) {
    EXPECT_TRUE(std::isfinite(hit.distance));
    EXPECT_TRUE(std::isfinite(hit.position.x + hit.position.y + hit.position.z));
}

TEST(ScreenHardCases, NoInvalidOperationAndNothingThatIsNotFinite) {
    for (const glm::ivec2 size : {glm::ivec2(1, 1), glm::ivec2(1, 9), glm::ivec2(9, 1),
                                  glm::ivec2(16, 16), glm::ivec2(33, 17), glm::ivec2(64, 48)}) {
        SurfaceMap map = map_of_hard_cases(size.x, size.y);
        std::vector<CameraRay> rays = hard_rays(map.lens);
        for (std::uint32_t i = 0; i < 500; ++i)
            rays.push_back(test::ray_from_anywhere(i));
        for (const bool flipped : {false, true}) {
            if (flipped) map.lens.fy = -map.lens.fy;
            std::vector<ScreenHit> fast, slow;
            {
                const test::FloatingPointTraps traps;
                const DepthPyramid pyramid = make_depth_pyramid(map, {});
                for (const CameraRay& ray : rays) {
                    fast.push_back(trace_screen(pyramid, ray));
                    slow.push_back(trace_screen_exhaustively(pyramid, ray));
                }
            }
            for (std::size_t i = 0; i < rays.size(); ++i) {
                expect_finite(fast[i]);
                EXPECT_GE(fast[i].distance, 0);
                EXPECT_EQ(int(fast[i].status), int(slow[i].status)) << size.x << " ray " << i;
                EXPECT_EQ(fast[i].distance, slow[i].distance) << size.x << " ray " << i;
            }
        }
    }
}

TEST(ScreenHardCases, ATinyTurnOfTheRayMovesItsHitATinyWay) {
    test::Room room;
    room.spheres = {{{0, 0, 2}, 0.5}};
    const SurfaceMap map = test::map_of(room, test::room_lens(320, 240));
    const DepthPyramid pyramid = make_depth_pyramid(map, {});
    int jumps = 0, hits = 0;
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const SampleKey key{31, 0, i, 0};
        const glm::dvec3 origin{uniform(key, 0) - 0.5, uniform(key, 1) - 0.5, 0.8};
        const glm::dvec3 target{0.5 * uniform(key, 2) - 0.25, 0.5 * uniform(key, 3) - 0.25, 1.7};
        const glm::dvec3 d = glm::normalize(target - origin);
        const glm::dvec3 turned = glm::normalize(d + glm::dvec3(1e-9, -1e-9, 1e-9));
        const ScreenHit a = trace_screen(pyramid, {origin, d});
        const ScreenHit b = trace_screen(pyramid, {origin, turned});
        ASSERT_EQ(int(a.status), int(ScreenStatus::hit));
        ASSERT_EQ(int(b.status), int(ScreenStatus::hit));
        ++hits;
        // A turn of 1e-9 rad moves the hit by less than 1e-8 m; where it changes pixels, tangent
        // planes of neighbours differ by the curvature over a pixel: (7 mm)^2 / (2 x 0.5 m) = 5e-5
        // m.
        EXPECT_LT(std::abs(a.distance - b.distance), 1e-3) << i;
        jumps += std::abs(a.distance - b.distance) > 1e-7;
    }
    EXPECT_LE(jumps, hits / 1000);  // 1e-9 rad of a pixel of 3e-3 rad changes it once in 1e6
}

}  // namespace
}  // namespace inlay
