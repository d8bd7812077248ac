// A small tabletop, its exact frames, and objects to put on it: input for tests of the frame loop.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "render/sample/environment_sampler.h"
#include "render/trace/picture.h"

#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace inlay::test {

/// A rectangle through `centre`, spanned by two half edges; its normal is their cross product.
inline TriangleMesh rectangle(const glm::vec3& centre, const glm::vec3& u, const glm::vec3& v) {
    TriangleMesh mesh;
    mesh.positions = {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

inline SceneObject mesh_object(const char* name, TriangleMesh mesh, Rgb reflectance, bool real) {
    SceneObject object;
    object.name = name;
    object.parts.push_back(
        {MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh))}, Diffuse{reflectance}});
    object.motion.push_back({0.0, glm::dmat4(1)});
    object.real = real;
    return object;
}

inline SceneObject ball(const char* name, const glm::dvec3& centre, float radius, Material material,
                        bool real) {
    SceneObject object;
    object.name = name;
    object.parts.push_back({SphereShape{radius}, std::move(material)});
    object.motion.push_back({0.0, glm::translate(glm::dmat4(1), centre)});
    object.real = real;
    return object;
}

/// y is up: a table at y = 0, two walls, and a real ball.
inline VirtualScene tabletop() {
    VirtualScene scene;
    scene.objects.push_back(mesh_object("table", rectangle({0, 0, 0}, {0.8f, 0, 0}, {0, 0, -0.8f}),
                                        Rgb(0.6f, 0.5f, 0.4f), true));
    scene.objects.push_back(mesh_object(
        "back", rectangle({0, 0.4f, -0.6f}, {0.8f, 0, 0}, {0, 0.4f, 0}), Rgb(0.5f), true));
    scene.objects.push_back(mesh_object("side",
                                        rectangle({-0.6f, 0.4f, 0}, {0, 0, -0.8f}, {0, 0.4f, 0}),
                                        Rgb(0.3f, 0.5f, 0.6f), true));
    scene.objects.push_back(
        ball("stone", {-0.25, 0.1, -0.15}, 0.1f, Diffuse{Rgb(0.5f, 0.4f, 0.3f)}, true));
    return scene;
}

/// A diffuse and a glossy ball that stand on the table.
inline VirtualScene two_virtual_balls() {
    VirtualScene scene;
    scene.objects.push_back(
        ball("red", {0.05, 0.08, 0.05}, 0.08f, Diffuse{Rgb(0.8f, 0.2f, 0.1f)}, false));
    scene.objects.push_back(
        ball("chrome", {0.25, 0.06, 0.0}, 0.06f, Phong{Rgb(0.05f), Rgb(0.8f), 64}, false));
    return scene;
}

/// Brighter from above and from one side; bandwidth low enough for few samples.
inline EnvironmentMap soft_light() {
    EnvironmentMap map;
    map.radiance = Image<Rgb>(64, 32);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 64; ++x) {
            const glm::dvec3 d = direction_from_texel(map.radiance, {x + 0.5, y + 0.5});
            const double lobe =
                std::exp(6 * (glm::dot(d, glm::normalize(glm::dvec3(1, 2, 1))) - 1));
            map.radiance(x, y) =
                Rgb(0.25f + 0.1f * float(d.y)) + Rgb(1.2f, 1.1f, 1.0f) * float(lobe);
        }
    }
    return map;
}

/// A camera that looks at the table's middle, `angle` (rad) around it.
inline Pose camera_around(double angle) {
    const glm::dvec3 eye{0.9 * std::sin(angle), 0.6, 0.9 * std::cos(angle)};
    const glm::dvec3 forward = glm::normalize(glm::dvec3(0, 0.05, 0) - eye);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 1, 0)));
    return {glm::dmat3(right, glm::cross(forward, right), forward), eye};
}

/// What an exact camera records of the real objects.
inline RgbdFrame record_frame(const VirtualScene& scene, const Lens& lens, int index) {
    const Pose world_from_camera = camera_around(0.01 * index);
    EmbreeSceneCache structures;
    const EmbreeScene real = structures.place(scene, 0, true);
    RgbdFrame frame;
    frame.index = index;
    frame.time = index / 30.0;
    frame.lens = lens;
    frame.color = encode(trace_picture(real, make_environment_sampler(soft_light()),
                                       {lens, world_from_camera, 1, std::uint32_t(index)}, 16)
                             .radiance);
    frame.depth = trace_depth(real, lens, world_from_camera);
    frame.recorded_world_from_camera = world_from_camera;
    return frame;
}

}  // namespace inlay::test
