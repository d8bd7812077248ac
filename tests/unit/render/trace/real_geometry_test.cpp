// RealGeometry: what the photograph and the exact objects answer to rays.
#include "render/trace/real_geometry.h"

#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

namespace inlay::test {
namespace {

/// A wall at depth 2 seen frontally, with one hole, and its photograph of radiance 3.
struct Wall {
    SurfaceMap map;
    Image<Rgb> photo;

    Wall()
        : map(empty_surface_map(lens_of(9, 7, 8), look_at({0, 0, 4}, {0, 0, 0}))),
          photo(9, 7, Rgb(3)) {
        for (int y = 0; y < 7; ++y) {
            for (int x = 0; x < 9; ++x) {
                map.position(x, y) = glm::vec3(2.0 * unproject(map.lens, {x, y}));
                map.normal(x, y) = {0, 0, -1};
            }
        }
        map.position(4, 3) = map.normal(4, 3) = glm::vec3(0);
    }
};

TEST(MeshRealGeometry, CameraRaysMeetTheSurfaceMapAndMissItsHoles) {
    const Wall wall;
    const EmbreeScene no_mesh;
    const RealGeometry real = mesh_real_geometry({wall.map, wall.photo}, no_mesh, 1e-3f, 0.05f);
    RayPacket rays;
    std::array<glm::ivec2, packet_width> pixels{};
    pixels[0] = {1, 2}, pixels[1] = {4, 3};
    for (int lane = 0; lane < 2; ++lane) {
        const glm::dvec3 d = unproject(wall.map.lens, glm::dvec2(pixels[std::size_t(lane)]));
        rays.set(lane, {0, 0, 4},
                 glm::vec3(glm::normalize(wall.map.world_from_camera.rotation * d)));
    }
    const auto hits = real.primary(rays, pixels).pixel;
    const glm::dvec3 expected = wall.map.world_from_camera * glm::dvec3(wall.map.position(1, 2));
    EXPECT_TRUE(near(hits[0].position, expected, 1e-5));
    EXPECT_TRUE(near(hits[0].normal, {0, 0, 1}, 1e-6));
    EXPECT_EQ(hits[1].distance, no_hit);
}

TEST(MeshRealGeometry, SurfacesSeenByThePhotographHaveItsRadianceOthersTheirColor) {
    const Wall wall;
    TriangleMesh mesh = quad({-5, -5, 2}, {10, 0, 0}, {0, 10, 0});  // the wall, and beyond the view
    append(mesh, quad({-5, -5, -3}, {10, 0, 0}, {0, 10, 0}));       // hidden behind it
    mesh.colors.assign(8, Rgb(0.5f));
    EmbreeSceneCache cache;
    const EmbreeScene placed = cache.place(std::make_shared<TriangleMesh>(mesh));
    const RealGeometry real = mesh_real_geometry({wall.map, wall.photo}, placed, 1e-3f, 0.05f);
    RayPacket rays;
    rays.set(0, {0.5f, 0.5f, 3}, {0, 0, -1});   // at the wall, in view
    rays.set(1, {4.5f, 4.5f, 3}, {0, 0, -1});   // at the wall, out of view
    rays.set(2, {0.5f, 0.5f, -1}, {0, 0, -1});  // at the hidden surface
    rays.set(3, {0, 0, 3}, {0, 0, 1});          // at nothing
    const RealHits hits = real.radiances(rays, {});
    EXPECT_EQ(hits.radiance[0], Rgb(3));
    EXPECT_TRUE(near(hits.radiance[1], glm::dvec3(0.5), 1e-6));
    EXPECT_TRUE(near(hits.radiance[2], glm::dvec3(0.5), 1e-6));
    EXPECT_EQ(hits.distance[3], no_hit);
    EXPECT_NEAR(hits.distance[0], 1, 1e-5);
}

TEST(Triangulate, CoversTheMapButNeitherHolesNorDepthSteps) {
    Wall wall;
    const auto triangles = [&] {
        return triangulate({wall.map, wall.photo}, 0.1f).triangles.size();
    };
    const TriangleMesh mesh = triangulate({wall.map, wall.photo}, 0.1f);
    EXPECT_EQ(mesh.positions.size(), 9U * 7 - 1);
    // 8 x 6 squares of two triangles; the hole takes the 6 triangles that touch its pixel.
    EXPECT_EQ(mesh.triangles.size(), 8U * 6 * 2 - 6);
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 n = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                       mesh.positions[t.z] - mesh.positions[t.x]);
        EXPECT_GT(n.z, 0);  // towards the camera
    }
    const std::size_t before = triangles();
    wall.map.position(1, 1) *= 1.5f;  // a step of 50 %
    EXPECT_EQ(triangles(), before - 6);
}

TEST(ExactRealGeometry, ShinesAsThePathTracerSays) {
    const PlacedScene scene({mesh_object(floor_mesh(1), Diffuse{Rgb(0)}, true)});
    const EnvironmentSampler sky = constant_environment(1);
    const RealGeometry real = exact_real_geometry(scene.real, sky, real_light_dimension);
    RayPacket rays;
    rays.set(0, {0, 1, 0}, {0, -1, 0});  // at a black floor
    rays.set(1, {0, 1, 0}, {0, 1, 0});   // at the sky, which is no surface
    const RealHits hits = real.radiances(rays, {});
    EXPECT_EQ(hits.radiance[0], Rgb(0));
    EXPECT_EQ(hits.radiance[1], Rgb(0));
    EXPECT_EQ(hits.distance[1], no_hit);
    const auto primary = real.primary(rays, {}).pixel;
    EXPECT_EQ(primary[0].normal, glm::vec3(0, 1, 0));
    EXPECT_EQ(primary[1].distance, no_hit);
}

}  // namespace
}  // namespace inlay::test
