#include "slam/edges/follow_photograph.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace inlay {
namespace {

const Lens lens{120, 90, 100, 100, 59.5, 44.5};
constexpr float near_z = 1, far_z = 2;  // m, of a disk and of the wall behind it
constexpr float radius = 20.3f;         // px, of the disk
const Rgb disk_color{0.5f, 0.25f, 0.1f}, wall_color{0.2f, 0.3f, 0.35f};

float from_middle(float x, float y) { return std::hypot(x - 60.2f, y - 44.1f); }

/// The disk's share of a pixel.
float true_share(int x, int y) {
    constexpr int side = 8;
    int inside = 0;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            inside += from_middle(float(x) + (float(i) + 0.5f) / side - 0.5f,
                                  float(y) + (float(j) + 0.5f) / side - 0.5f) < radius;
    return float(inside) / (side * side);
}

Image<EncodedRgb> photograph(const Rgb& disk, const Rgb& wall) {
    Image<EncodedRgb> photo(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const float noise =
                1 + 0.06f * (uniform({1, 0, std::uint32_t(y * lens.width + x), 0}, 0) - 0.5f);
            photo(x, y) = encode(noise * glm::mix(wall, disk, true_share(x, y)));
        }
    }
    return photo;
}

/// The disk before the wall, as depth says: `depth_at` gives 0 for a hole.
SurfaceMap seen(const std::function<float(int x, int y)>& depth_at) {
    SurfaceMap map = empty_surface_map(lens, {});
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const float z = depth_at(x, y);
            if (!(z > 0)) continue;
            map.position(x, y) = z * glm::vec3(unproject(lens, {x, y}));
            map.normal(x, y) = {0, 0, -1};
            map.confidence(x, y) = 1;
        }
    }
    return map;
}

SurfaceMap disk_of_radius(float r, float wall_z = far_z) {
    return seen(
        [=](int x, int y) { return from_middle(float(x), float(y)) < r ? near_z : wall_z; });
}

/// The share of a pixel that the map gives to the disk.
float share_in(const SurfaceMap& map, int x, int y) {
    const auto is_near = [](const glm::vec3& p) { return p.z > 0 && p.z < 1.02f; };
    const bool own = is_near(map.position(x, y));
    const std::uint32_t number = map.split.number.empty() ? 0 : map.split.number(x, y);
    if (number == 0) return own ? 1.0f : 0.0f;
    const SecondSurface& second = map.split.second[number - 1];
    constexpr int side = 16;
    int near = 0;
    for (int j = 0; j < side; ++j) {
        for (int i = 0; i < side; ++i) {
            const glm::vec2 at((float(i) + 0.5f) / side - 0.5f, (float(j) + 0.5f) / side - 0.5f);
            const bool on_second = glm::dot(at, second.towards) > second.edge;
            near += on_second ? is_near(second.position) : own;
        }
    }
    return float(near) / (side * side);
}

/// The area between the map's edge and the true one, per length of the edge (px).
float boundary_error(const SurfaceMap& map) {
    float area = 0;
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x)
            area += std::abs(share_in(map, x, y) - true_share(x, y));
    return area / (2 * 3.14159f * radius);
}

EdgeSettings reaching(float pixels) {
    EdgeSettings settings;
    settings.reach = pixels * near_z / float(lens.fx);
    return settings;
}

TEST(FollowPhotograph, EdgesThatAreOffByTwoPixelsMoveToTheColorEdge) {
    const Image<EncodedRgb> photo = photograph(disk_color, wall_color);
    for (const float off : {-2.0f, -1.0f, 0.0f, 1.0f, 2.0f}) {
        SurfaceMap map = disk_of_radius(radius + off);
        const float before = boundary_error(map);
        EXPECT_NEAR(before, std::max(0.3f, std::abs(off)),
                    0.15f);  // whole pixels are a quarter off
        follow_photograph(map, photo, reaching(4));
        EXPECT_LT(boundary_error(map), 0.15f)
            << off;                               // of color noise, and of the wrong half-plane
        EXPECT_GT(map.split.second.size(), 60U);  // of about 126 px of edge
    }
}

TEST(FollowPhotograph, StepsOfAFewHundredthsMoveToo) {
    for (const float wall_z : {1.05f, 1.06f, 1.08f, 1.2f}) {
        SurfaceMap map = disk_of_radius(radius - 2, wall_z);
        follow_photograph(map, photograph(disk_color, wall_color), reaching(4));
        EXPECT_LT(boundary_error(map), 0.15f) << wall_z;
    }
}

/// Bars and slits of a few pixels, all of them nearer to an edge than depth is trusted.
TEST(FollowPhotograph, ThinThingsKeepTheirDepth) {
    const Image<EncodedRgb> photo = photograph(disk_color, wall_color);
    for (int width = 1; width <= 8; ++width) {
        for (const bool bar : {true, false}) {
            const SurfaceMap before = seen(
                [=](int x, int) { return (x >= 50 && x < 50 + width) == bar ? near_z : far_z; });
            SurfaceMap map = before;
            follow_photograph(map, photo, reaching(4));
            EXPECT_EQ(map.position.pixels, before.position.pixels) << width << bar;
        }
    }
}

/// A square before a book before a wall: no pixel takes the depth of what its color is not.
TEST(FollowPhotograph, ThreeSurfacesThatMeetStayApart) {
    const std::array<float, 3> depths{1.0f, 1.3f, 2.5f};
    const std::array<Rgb, 3> colors{disk_color, {0.1f, 0.4f, 0.15f}, wall_color};
    const auto surface_at = [](int x, int y) {
        return y < 40   ? 2
               : x < 60 ? 0
               : x < 75 ? 1
                        : 2;  // the book's width is one and a half bands
    };
    Image<EncodedRgb> photo(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x)
            photo(x, y) = encode(colors[std::size_t(surface_at(x, y))]);
    SurfaceMap map = seen([&](int x, int y) { return depths[std::size_t(surface_at(x, y))]; });
    follow_photograph(map, photo, reaching(4));
    for (int y = 0; y < lens.height; ++y)
        for (int x = 0; x < lens.width; ++x)
            EXPECT_NEAR(map.position(x, y).z, depths[std::size_t(surface_at(x, y))], 1e-4f)
                << x << ' ' << y;
}

TEST(FollowPhotograph, HolesAlongTheEdgeAreFilledOnBothSides) {
    SurfaceMap map = seen([](int x, int y) {
        const float r = from_middle(float(x), float(y));
        return r < radius - 3 ? near_z : r < radius + 2 ? 0.0f : far_z;
    });
    follow_photograph(map, photograph(disk_color, wall_color), reaching(4));
    for (const glm::vec3& p : map.position.pixels)
        EXPECT_GT(p.z, 0);
    EXPECT_LT(boundary_error(map), 0.15f);
}

TEST(FollowPhotograph, WithoutContrastDepthStaysAsItWas) {
    const SurfaceMap before = disk_of_radius(radius - 2);
    SurfaceMap map = before;
    follow_photograph(map, photograph(wall_color, wall_color), reaching(4));
    EXPECT_EQ(map.position.pixels, before.position.pixels);
    EXPECT_TRUE(map.split.second.empty());
}

TEST(FollowPhotograph, APlaneHasNoEdges) {
    // steep enough that neighbours differ by 4 % of depth
    SurfaceMap map = empty_surface_map(lens, {});
    const glm::vec3 normal = glm::normalize(glm::vec3(0, -0.25f, -1));
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::vec3 ray(unproject(lens, {x, y}));
            map.position(x, y) = ray * (-2.0f / glm::dot(normal, ray));
            map.normal(x, y) = normal;
        }
    }
    const SurfaceMap before = map;
    follow_photograph(map, photograph(disk_color, wall_color), reaching(4));
    EXPECT_EQ(map.position.pixels, before.position.pixels);
    EXPECT_TRUE(map.split.second.empty());
}

TEST(FollowPhotograph, BytesDoNotDependOnThreads) {
    const Image<EncodedRgb> photo = photograph(disk_color, wall_color);
    SurfaceMap one = disk_of_radius(radius + 1), three = one;
    set_thread_count(1);
    follow_photograph(one, photo, reaching(4));
    set_thread_count(3);
    follow_photograph(three, photo, reaching(4));
    set_thread_count(0);
    EXPECT_EQ(one.position.pixels, three.position.pixels);
    EXPECT_EQ(one.normal.pixels, three.normal.pixels);
    EXPECT_EQ(one.confidence.pixels, three.confidence.pixels);
    EXPECT_EQ(one.split.number.pixels, three.split.number.pixels);
    ASSERT_EQ(one.split.second.size(), three.split.second.size());
    for (std::size_t i = 0; i < one.split.second.size(); ++i) {
        EXPECT_EQ(one.split.second[i].position, three.split.second[i].position);
        EXPECT_EQ(one.split.second[i].edge, three.split.second[i].edge);
    }
}

TEST(FollowPhotograph, HardMapsStayFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    SurfaceMap steps = seen([](int x, int y) { return (x + y) % 2 == 0 ? near_z : far_z; });
    SurfaceMap holes = seen([](int, int) { return 0.0f; });
    SurfaceMap specks =
        seen([](int x, int y) { return x % 17 == 3 && y % 13 == 2 ? 1e-30f : 0.0f; });
    SurfaceMap flat = disk_of_radius(radius);
    for (glm::vec3& n : flat.normal.pixels)
        n = glm::vec3(1, 0, 0);  // seen from the side
    SurfaceMap unknown = disk_of_radius(radius);
    unknown.normal(60, 64) = glm::vec3(nan);
    for (SurfaceMap* map : {&steps, &holes, &specks, &flat}) {
        follow_photograph(*map, photograph(disk_color, wall_color), reaching(8));
        for (const glm::vec3& p : map->position.pixels)
            EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.z));
        for (const SecondSurface& second : map->split.second)
            EXPECT_TRUE(std::isfinite(second.edge) && std::isfinite(second.position.z));
    }
    EXPECT_NO_THROW(follow_photograph(unknown, photograph(disk_color, wall_color), reaching(8)));
    SurfaceMap tiny = empty_surface_map({1, 1, 1, 1, 0, 0}, {});
    EXPECT_NO_THROW(follow_photograph(tiny, Image<EncodedRgb>(1, 1), reaching(4)));
}

TEST(FollowPhotograph, RefusesAPhotographOfAnotherSize) {
    SurfaceMap map = disk_of_radius(radius);
    EXPECT_THROW(follow_photograph(map, Image<EncodedRgb>(7, 5), {}), Error);
}

}  // namespace
}  // namespace inlay
