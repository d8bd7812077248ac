// EmbreeScene: where rays meet placed meshes and spheres, and what the surface is like there.
#include "render/trace/embree_scene.h"

#include "recordings/base/random.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay::test {
namespace {

SurfaceHit first_hit(const EmbreeScene& scene, const glm::vec3& origin,
                     const glm::vec3& direction) {
    RayPacket rays;
    rays.set(3, origin, glm::normalize(direction));
    return scene.intersect(rays)[3];
}

TEST(EmbreeScene, HitsASphereWhereTheClosedFormSays) {
    const PlacedScene scene({sphere_object({1, 2, 3}, 0.5f, Diffuse{})});
    const glm::vec3 centre{1, 2, 3}, origin{0, 0, 0};
    int hits = 0;
    for (std::uint32_t i = 0; i < 500; ++i) {
        const glm::vec2 u = stratified_pair({1, 0, 0, i}, 0);
        const glm::vec3 d = glm::normalize(centre + glm::vec3(u.x - 0.5f, u.y - 0.5f, 0) * 1.5f);
        const float along = glm::dot(d, centre);
        const float h2 = 0.25f - (glm::dot(centre, centre) - along * along);
        const SurfaceHit hit = first_hit(scene.all, origin, d);
        if (std::abs(h2) < 1e-4f) continue;  // at the rim, float decides
        ASSERT_EQ(hit.hit(), h2 > 0);
        if (!hit.hit()) continue;
        ++hits;
        EXPECT_NEAR(hit.distance, along - std::sqrt(h2), 2e-4);
        const SurfacePoint p = scene.all.surface_point(hit, origin, d);
        EXPECT_NEAR(glm::length(p.position - centre), 0.5, 1e-6);
        EXPECT_TRUE(near(p.geometric_normal, (p.position - centre) / 0.5f, 1e-5));
    }
    EXPECT_GT(hits, 100);
}

/// A bound that is too small would hide directions from what aims at it: uneven scales, shear and
/// more parts than there are bounds included.
TEST(EmbreeScene, BoundsHoldEveryVertexHoweverPlaced) {
    std::vector<SceneObject> objects;
    for (int i = 0; i < 200; ++i) {
        SceneObject object = mesh_object(bowl_mesh(0.2, 6), Diffuse{});
        glm::dmat4& m = object.motion[0].world_from_object;
        const SampleKey key{1, 0, std::uint32_t(i), 0};
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                m[column][row] =
                    (column == row ? 0.1 + uniform(key, 0) : 0.0) +
                    (i % 2 == 0 ? 0.3 * uniform(key, std::uint32_t(3 * column + row + 1)) : 0.0);
        m[3] = {4.0 * uniform(key, 20), 4.0 * uniform(key, 21), 4.0 * uniform(key, 22), 1};
        objects.push_back(object);
    }
    objects.push_back(sphere_object({1, 2, 3}, 0.5f, Diffuse{}));
    const PlacedScene scene(objects);
    ASSERT_FALSE(scene.all.bounds().empty());
    EXPECT_LE(scene.all.bounds().size(), 64u);
    const auto held = [&](const glm::vec3& p) {
        return std::any_of(scene.all.bounds().begin(), scene.all.bounds().end(),
                           [&](const BoundingSphere& s) {
                               return glm::distance(s.centre, p) <= s.radius * 1.00001f;
                           });
    };
    for (const PlacedPart& part : scene.all.parts()) {
        if (!part.mesh) continue;
        for (const glm::vec3& p : part.mesh->positions)
            EXPECT_TRUE(held(glm::vec3(part.world_from_local * glm::vec4(p, 1))));
    }
    EXPECT_TRUE(held({1, 2.5f, 3}));
    EXPECT_TRUE(PlacedScene({}).all.bounds().empty());
}

TEST(EmbreeScene, SeesASphereFromInside) {
    const PlacedScene scene({sphere_object({0, 0, 0}, 2, Diffuse{})});
    for (const glm::vec3& d : {glm::vec3(1, 0, 0), {0, -1, 0}, {1, 1, 1}}) {
        const SurfaceHit hit = first_hit(scene.all, {0, 0, 0}, d);
        ASSERT_TRUE(hit.hit());
        EXPECT_NEAR(hit.distance, 2, 1e-5);
    }
}

TEST(EmbreeScene, PlacesObjectsByRotationScaleAndShift) {
    glm::dmat4 world_from_object(0.0);  // 90 degrees about z, twice the size, shifted
    world_from_object[0] = {0, 2, 0, 0};
    world_from_object[1] = {-2, 0, 0, 0};
    world_from_object[2] = {0, 0, 2, 0};
    world_from_object[3] = {10, 0, 0, 1};
    const auto mesh = std::make_shared<TriangleMesh>(floor_mesh(1));
    const PlacedScene scene({object_of(MeshShape{mesh}, Diffuse{}, world_from_object, false)});
    // The floor's normal +y turns into -x; the plane stands at x = 10.
    const glm::vec3 origin{5, 1.5f, -1.5f}, direction{1, 0, 0};
    const SurfaceHit hit = first_hit(scene.all, origin, direction);
    ASSERT_TRUE(hit.hit());
    EXPECT_NEAR(hit.distance, 5, 1e-5);
    const SurfacePoint p = scene.all.surface_point(hit, origin, direction);
    EXPECT_TRUE(near(p.position, {10, 1.5, -1.5}, 1e-5));
    EXPECT_TRUE(near(p.geometric_normal, {-1, 0, 0}, 1e-6));
    EXPECT_FALSE(first_hit(scene.all, {5, 2.1f, 0}, direction).hit());  // half-width 2
}

TEST(EmbreeScene, InterpolatesWhatVerticesCarry) {
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
    mesh.texture_coordinates = {{0, 0}, {1, 0}, {0, 1}};
    mesh.colors = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 1, 2}};
    const PlacedScene scene({mesh_object(mesh, Diffuse{})});
    const glm::vec3 origin{0.25f, 0.5f, 3}, direction{0, 0, -1};
    const SurfaceHit hit = first_hit(scene.all, origin, direction);
    ASSERT_TRUE(hit.hit());
    const SurfacePoint p = scene.all.surface_point(hit, origin, direction);
    EXPECT_TRUE(near(p.position, {0.25, 0.5, 0}, 1e-6));
    EXPECT_TRUE(near(p.vertex_color, {0.25, 0.25, 0.5}, 1e-6));
    EXPECT_TRUE(near(p.shading_normal, glm::normalize(glm::vec3(0.5, 0.25, 0.25)), 1e-6));
    EXPECT_NEAR(p.uv.x, 0.25, 1e-6);
    EXPECT_NEAR(p.uv.y, 0.5, 1e-6);
}

TEST(EmbreeScene, OccludedAgreesWithIntersectLaneByLane) {
    const PlacedScene scene(
        {sphere_object({0, 0, -3}, 1, Diffuse{}), mesh_object(cube_mesh(0.5f), Diffuse{})});
    RayPacket rays;
    for (int lane = 0; lane < packet_width; lane += 1 + lane % 3) {
        const float angle = float(lane) * 0.4f;
        rays.set(lane, {0, 0, 2}, glm::normalize(glm::vec3(std::sin(angle), 0, -std::cos(angle))));
    }
    const HitPacket hits = scene.all.intersect(rays);
    const std::uint32_t blocked = scene.all.occluded(rays);
    EXPECT_NE(blocked, 0U);
    EXPECT_NE(blocked, rays.active);
    for (int lane = 0; lane < packet_width; ++lane)
        EXPECT_EQ(bool((blocked >> lane) & 1U), hits[std::size_t(lane)].hit()) << lane;
}

TEST(EmbreeScene, AnEmptySceneIsNeverHit) {
    const EmbreeScene empty;
    RayPacket rays;
    rays.set(0, {0, 0, 0}, {0, 0, 1});
    EXPECT_FALSE(empty.intersect(rays)[0].hit());
    EXPECT_EQ(empty.occluded(rays), 0U);
    const PlacedScene scene({mesh_object(TriangleMesh{}, Diffuse{})});
    EXPECT_FALSE(scene.all.intersect(rays)[0].hit());
}

TEST(EmbreeScene, RealAndVirtualObjectsArePlacedApartAndKeepTheirIndex) {
    const PlacedScene scene({sphere_object({0, 0, 5}, 1, Diffuse{}, true),
                             sphere_object({0, 0, 9}, 1, Diffuse{}, false)});
    EXPECT_NEAR(first_hit(scene.real, {0, 0, 0}, {0, 0, 1}).distance, 4, 1e-5);
    EXPECT_NEAR(first_hit(scene.virtual_, {0, 0, 0}, {0, 0, 1}).distance, 8, 1e-5);
    EXPECT_NEAR(first_hit(scene.all, {0, 0, 0}, {0, 0, 1}).distance, 4, 1e-5);
    ASSERT_EQ(scene.virtual_.parts().size(), 1U);
    EXPECT_EQ(scene.virtual_.parts()[0].object, 1U);
}

TEST(EmbreeScene, ACubeOfSharedCornersIsTight) {
    const PlacedScene scene({mesh_object(cube_mesh(1), Diffuse{})});
    for (std::uint32_t i = 0; i < 2000; ++i) {
        // towards points on the cube's edges: between two triangles, where rays slip through
        const float t = 2 * uniform({1, 0, 0, i}, 0) - 1;
        const glm::vec3 edge = i % 3 == 0   ? glm::vec3(t, 1, 1)
                               : i % 3 == 1 ? glm::vec3(-1, t, 1)
                                            : glm::vec3(1, -1, t);
        EXPECT_TRUE(first_hit(scene.all, {0.1f, -0.2f, 0.05f}, edge).hit());
    }
}

}  // namespace
}  // namespace inlay::test
