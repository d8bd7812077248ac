// Bounding spheres: nothing sticks out, and loose shapes get more than one.
#include "render/trace/bounding_spheres.h"

#include "recordings/base/random.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace inlay::test {
namespace {

bool holds(const std::vector<BoundingSphere>& spheres, const BoundingSphere& part) {
    return std::any_of(spheres.begin(), spheres.end(), [&](const BoundingSphere& s) {
        return glm::distance(s.centre, part.centre) + part.radius <= s.radius;
    });
}

std::vector<BoundingSphere> random_spheres(int count, std::uint32_t seed) {
    std::vector<BoundingSphere> spheres;
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        const SampleKey key{seed, 0, i, 0};
        spheres.push_back(
            {4.0f * glm::vec3(uniform(key, 0), uniform(key, 1), uniform(key, 2)) - 2.0f,
             0.3f * uniform(key, 3) * uniform(key, 3)});
    }
    return spheres;
}

TEST(BoundingSpheres, HoldEveryPartWholly) {
    for (const int count : {1, 2, 3, 17, 200}) {
        for (const int most : {1, 2, 16, 64}) {
            const auto parts = random_spheres(count, std::uint32_t(count));
            const auto spheres = enclosing_spheres(parts, most);
            EXPECT_LE(int(spheres.size()), most);
            for (const BoundingSphere& part : parts)
                EXPECT_TRUE(holds(spheres, part)) << count << " parts, " << most << " spheres";
        }
    }
    EXPECT_TRUE(enclosing_spheres(std::vector<BoundingSphere>{}, 8).empty());
}

TEST(BoundingSpheres, HoldEveryTriangleOfAMesh) {
    const TriangleMesh mesh = bowl_mesh(0.3, 12);
    const auto spheres = enclosing_spheres(mesh, 16);
    for (const glm::uvec3& t : mesh.triangles) {
        const bool held = std::any_of(spheres.begin(), spheres.end(), [&](const BoundingSphere& s) {
            return std::max({glm::distance(s.centre, mesh.positions[t.x]),
                             glm::distance(s.centre, mesh.positions[t.y]),
                             glm::distance(s.centre, mesh.positions[t.z])}) <= s.radius;
        });
        EXPECT_TRUE(held);
    }
}

/// Four thin legs under nothing: one sphere around all is hundreds of times the sum of their own.
TEST(BoundingSpheres, LegsGetSpheresOfTheirOwn) {
    TriangleMesh legs;
    for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
            append(legs, quad({x, 0, z}, {0.02f, 0, 0}, {0, 0.1f, 0}));
    const auto spheres = enclosing_spheres(legs, 16);
    EXPECT_GE(spheres.size(), 4u);
    for (const BoundingSphere& s : spheres)
        EXPECT_LT(s.radius, 0.1f);
}

/// A cube's halves need spheres nearly as large as its own.
TEST(BoundingSpheres, ACompactShapeGetsOne) {
    EXPECT_EQ(enclosing_spheres(cube_mesh(0.5f), 16).size(), 1u);
}

TEST(BoundingSpheres, TheSamePointManyTimesKeepsItsPlace) {
    const std::vector<BoundingSphere> parts(1000, {{1, 2, 3}, 0});
    const auto spheres = enclosing_spheres(parts, 64);
    ASSERT_FALSE(spheres.empty());
    for (const BoundingSphere& s : spheres) {
        EXPECT_EQ(s.centre, glm::vec3(1, 2, 3));
        EXPECT_EQ(s.radius, 0);
    }
}

}  // namespace
}  // namespace inlay::test
