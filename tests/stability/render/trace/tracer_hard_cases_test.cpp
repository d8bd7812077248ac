// Hard geometry: coincident, degenerate, tiny, enclosing, grazing, absent. All outputs finite.
#include "recordings/base/random.h"
#include "render/trace/picture.h"
#include "tests/support/floating_point_traps.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace inlay::test {
namespace {

const Pose view = look_at({0, 1, 2}, {0, 0.2, 0});

EnvironmentSampler hard_light() { return environment_of(hot_pixel_map(9, 4, 5e4f, 0.2f)); }

NoisyLayers sound_layers(std::vector<SceneObject> objects, const Pose& from = view,
                         const Lens& lens = lens_of(24, 18, 24)) {
    const PlacedScene scene(std::move(objects));
    NoisyLayers layers = sample_scene(scene, hard_light(), lens, from, {}).layers;
    expect_sound(layers);
    const SamplingSettings apart{.estimator = Estimator::difference};
    const NoisyLayers difference = sample_scene(scene, hard_light(), lens, from, apart).layers;
    expect_sound(difference);
    EXPECT_EQ(difference.dropped_samples, 0U);
    const Picture picture = trace_picture(scene.all, hard_light(), {lens, from}, 4);
    EXPECT_TRUE(sound(picture.radiance, "radiance"));
    EXPECT_EQ(layers.dropped_samples + picture.dropped_samples, 0U);
    return layers;
}

SceneObject real_floor() { return mesh_object(floor_mesh(3), Diffuse{Rgb(0.6f)}, true); }

TEST(HardGeometry, AVirtualObjectThatCoincidesWithARealSurface) {
    const std::vector<SceneObject> objects{real_floor(),
                                           mesh_object(floor_mesh(1), Diffuse{Rgb(0.5f)})};
    sound_layers(objects);  // rounding decides which of the two is seen
    SamplingSettings settings;
    settings.depth_tolerance = 1e-5f;  // above rounding: the virtual one is, and the sky reaches it
    const NoisyLayers layers =
        sample_scene(PlacedScene(objects), hard_light(), lens_of(24, 18, 24), view, settings)
            .layers;
    expect_sound(layers);
    EXPECT_EQ(layers.m(12, 12), 0);
    EXPECT_GT(layers.direct.e_rv_virtual(12, 12).r, 0);
}

TEST(HardGeometry, CoincidenceLeavesNoRateBeyondTheRaysStart) {
    const PlacedScene scene({real_floor(), mesh_object(floor_mesh(1), Diffuse{Rgb(0.5f)}),
                             mesh_object(cube_mesh(0.3f), Diffuse{Rgb(0.5f)})});
    SamplingSettings settings;
    settings.occluder_floor = 0;
    const NoisyLayers layers =
        sample_scene(scene, hard_light(), lens_of(24, 18, 24), view, settings).layers;
    expect_sound(layers);
    for (const float rate : layers.virtual_.occluder_indirect.pixels)
        EXPECT_LE(rate, 1.001f / surface_offset);
}

TEST(HardGeometry, TheCameraInsideAnObject) {
    sound_layers({real_floor(), sphere_object({0, 1, 2}, 0.5f, Phong{Rgb(0.2f), Rgb(0.7f), 50})});
    SceneObject cube = mesh_object(cube_mesh(0.4f), Ggx{Rgb(0.8f), glm::vec2(0.3f), 0, nullptr});
    cube.motion[0].world_from_object[3] = {0, 1, 2, 1};
    const NoisyLayers layers = sound_layers({real_floor(), cube});
    EXPECT_EQ(layers.m(12, 9), 0);
}

TEST(HardGeometry, TheCameraOnASurface) {
    sound_layers({real_floor(), sphere_object({0, 0.3, 0}, 0.3f, Diffuse{})},
                 look_at({0, 0, 2}, {0, 0, 0}));
}

TEST(HardGeometry, DegenerateTriangles) {
    TriangleMesh mesh = floor_mesh(0.5f, 0.3f);
    const auto add = [&](const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        const auto first = std::uint32_t(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.triangles.emplace_back(first, first + 1, first + 2);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    add({0, 0.5f, 0}, {0, 0.5f, 0}, {0, 0.5f, 0});             // a point
    add({-1, 0.5f, 0}, {0, 0.5f, 0}, {1, 0.5f, 0});            // a line
    add({0, 0.6f, 0}, {1, 0.6f, 0}, {0.5f, 0.6f + 1e-7f, 0});  // a sliver
    add({0, 0.4f, 0.5f}, {1e-12f, 0.4f, 0.5f}, {0, 0.4f, 0.5f + 1e-12f});
    add({nan, 0, 0}, {0, 1, 0}, {1, 0, 0});
    add({1e30f, 0, 0}, {0, 1e30f, 0}, {0, 0, 1e30f});
    mesh.triangles.emplace_back(0, 0, 1);
    sound_layers({real_floor(), mesh_object(mesh, Phong{Rgb(0.5f), Rgb(0.5f), 20})});
}

TEST(HardGeometry, NormalsThatCancelOrVanish) {
    TriangleMesh mesh = floor_mesh(0.5f, 0.3f);
    for (const glm::vec3& n : {glm::vec3(0), glm::vec3(0, -1, 0)}) {
        mesh.normals.assign(4, n);
        sound_layers({real_floor(), mesh_object(mesh, Phong{Rgb(0.5f), Rgb(0.5f), 20})});
    }
    mesh.normals = {{1, 0, 0}, {-1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    sound_layers({real_floor(), mesh_object(mesh, Ggx{Rgb(0.5f), glm::vec2(0.1f), 0, nullptr})});
}

TEST(HardGeometry, SpheresOfEveryScale) {
    for (const float radius : {0.0f, 1e-20f, 1e-8f, 1e-4f, 1e-2f, 1e3f, 1e6f}) {
        SCOPED_TRACE(radius);
        sound_layers(
            {real_floor(), sphere_object({0, 0.2, 0}, radius, Phong{Rgb(0.5f), Rgb(0.5f), 20})},
            look_at({0, 1, 2}, {0, 0.2, 0}), telescope(6, 6));
    }
}

TEST(HardGeometry, ImagesThatFillNoTile) {
    for (const glm::ivec2 size :
         {glm::ivec2(1, 1), {1, 7}, {7, 1}, {3, 5}, {4, 4}, {5, 4}, {17, 2}}) {
        const NoisyLayers layers =
            sound_layers({real_floor(), sphere_object({0, 0.3, 0}, 0.3f, Diffuse{})}, view,
                         lens_of(size.x, size.y, 40));
        EXPECT_EQ(layers.m.width, size.x);
        EXPECT_EQ(layers.m.height, size.y);
        for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
            EXPECT_TRUE(layers.real.object.pixels[i] > 0 || layers.virtual_.object.pixels[i] > 0)
                << "pixel " << i << " of " << size.x << " x " << size.y << " was not sampled";
        }
    }
}

/// A real wall whose map answers to camera rays; nothing else is there to hit.
NoisyLayers layers_of_map(const SurfaceMap& map, const EmbreeScene& objects) {
    const Image<Rgb> photo(map.lens.width, map.lens.height, Rgb(0.5f));
    const EmbreeScene no_mesh;
    const RealGeometry real = mesh_real_geometry({map, photo}, no_mesh, 1e-3f, 0.05f);
    const EnvironmentSampler light = hard_light();
    NoisyLayers layers =
        sample_two_modes({map.lens, map.world_from_camera, real, objects, light}, {}, 0).layers;
    expect_sound(layers);
    EXPECT_EQ(layers.dropped_samples, 0U);
    return layers;
}

SurfaceMap wall_map() {
    SurfaceMap map = empty_surface_map(lens_of(9, 7, 8), view);
    for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 9; ++x) {
            map.position(x, y) = glm::vec3(2.0 * unproject(map.lens, {x, y}));
            map.normal(x, y) = {0, 0, -1};
        }
    }
    return map;
}

TEST(HardGeometry, HolesEverywhere) {
    const NoisyLayers layers =
        layers_of_map(empty_surface_map(lens_of(9, 7, 8), view), EmbreeScene{});
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        EXPECT_EQ(layers.m.pixels[i], 1);
        EXPECT_EQ(layers.real.object.pixels[i], 0U);
        EXPECT_EQ(layers.direct.e_r.pixels[i], Rgb(0));
    }
}

TEST(HardGeometry, ARealSurfaceWithoutANormalReceivesNoLight) {
    SurfaceMap map = wall_map();
    map.normal(4, 3) = glm::vec3(0);
    map.normal(2, 3) = glm::vec3(NAN);
    const NoisyLayers layers = layers_of_map(map, EmbreeScene{});
    for (const int x : {2, 4}) {
        EXPECT_EQ(layers.real.object(x, 3), 0U);
        EXPECT_EQ(layers.m(x, 3), 1);
    }
    EXPECT_EQ(layers.real.object(3, 3), 1U);
}

TEST(HardGeometry, GrazingAndAvertedNormals) {
    SurfaceMap map = wall_map();
    for (int x = 0; x < 9; ++x)  // from facing the camera to facing away
        for (int y = 0; y < 7; ++y) {
            const float angle = std::numbers::pi_v<float> * (float(x) / 8);
            map.normal(x, y) = {std::sin(angle), 0, -std::cos(angle)};
        }
    layers_of_map(map, EmbreeScene{});
}

TEST(HardGeometry, DepthThatIsNoDepth) {
    SurfaceMap map = wall_map();
    int x = 0;
    for (const float z : {NAN, INFINITY, -1.0f, 0.0f, 1e-6f, 1e-38f, 1e30f})
        map.position(x++, 3).z = z;
    layers_of_map(map, EmbreeScene{});
}

/// The code around the ray queries divides nothing by zero and overflows nowhere: real geometry is
/// a function here and there are no virtual objects, so that Embree is never called.
TEST(HardGeometry, TheSamplerRaisesNoFloatingPointException) {
    RealGeometry real = no_real_geometry();
    real.primary = [](const RayPacket& rays, const auto&) {
        RealPrimaryHits hits;
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (rays.has(int(i)) && rays.direction[i].y < 0)
                hits.pixel[i] = {1, rays.direction[i], glm::vec3(0, 1, 0)};
        }
        return hits;
    };
    real.radiances = [](const RayPacket& rays, const SampleKeys&) {
        RealHits hits;
        for (std::size_t i = 0; i < packet_width; ++i) {
            const bool hit = rays.has(int(i)) && rays.direction[i].x > 0;
            hits.distance[i] = hit ? 1e-6f : no_hit;
            hits.radiance[i] = Rgb(hit ? 1 : 0);
        }
        return hits;
    };
    const EmbreeScene no_objects;
    set_thread_count(1);  // traps are the calling thread's own
    for (const Image<Rgb>& map :
         {hot_pixel_map(3, 0, 5e4f), Image<Rgb>(8, 4, Rgb(0)), Image<Rgb>(1, 1, Rgb(1))}) {
        const EnvironmentSampler light = environment_of(map);
        const FloatingPointTraps traps;
        sample_two_modes({lens_of(9, 7, 8), view, real, no_objects, light}, {}, 0);
    }
    set_thread_count(0);
}

glm::vec3 random_vector(std::uint32_t i, std::uint32_t dimension, float size) {
    const auto u = [&](std::uint32_t d) { return 2 * uniform({9, 0, 0, i}, dimension + d) - 1; };
    return size * glm::vec3(u(0), u(1), u(2));
}

SceneObject random_object(std::uint32_t i) {
    const float choice = uniform({9, 1, 0, i}, 0), scale = std::pow(10.0f, 6 * choice - 4);
    const Material materials[] = {Diffuse{Rgb(choice)},
                                  Phong{Rgb(0.3f), Rgb(0.7f), std::pow(10.0f, 4 * choice)},
                                  Ggx{Rgb(0.9f), glm::vec2(choice, 1 - choice), choice, nullptr}};
    if (i % 2 == 0) return sphere_object(random_vector(i, 10, 1), scale, materials[i % 3]);
    TriangleMesh mesh;
    for (std::uint32_t v = 0; v < 12; ++v) {
        mesh.positions.push_back(random_vector(i, 20 + 3 * v, scale));
        mesh.normals.push_back(random_vector(i, 80 + 3 * v, v % 4 == 0 ? 0.0f : 1.0f));
        if (v >= 2) mesh.triangles.emplace_back(v, v - 1, v % 3 == 0 ? v - 1 : v - 2);
    }
    return mesh_object(mesh, materials[i % 3], i % 5 == 0);
}

TEST(HardGeometry, RandomDegenerateScenes) {
    for (std::uint32_t i = 0; i < 200; ++i) {
        SCOPED_TRACE(i);
        const glm::dvec3 eye(random_vector(i, 200, 2)), target(random_vector(i, 210, 1));
        sound_layers({real_floor(), random_object(3 * i), random_object(3 * i + 1),
                      random_object(3 * i + 2)},
                     look_at(eye, target), lens_of(5, 3, 1 + 40 * uniform({9, 2, 0, i}, 0)));
    }
}

}  // namespace
}  // namespace inlay::test
