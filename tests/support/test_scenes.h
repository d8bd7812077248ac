// Analytic scenes, lights and cameras whose light transport is known in closed form.
#pragma once

#include "recordings/base/parallel.h"
#include "render/trace/two_mode_sampler.h"

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace inlay::test {

/// A parallelogram: `corner`, its edges `a` and `b` (m); its normal is a x b.
inline TriangleMesh quad(const glm::vec3& corner, const glm::vec3& a, const glm::vec3& b) {
    TriangleMesh mesh;
    mesh.positions = {corner, corner + a, corner + a + b, corner + b};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    return mesh;
}

/// A square of half-width `half` (m) in the plane y = `height`, facing +y.
inline TriangleMesh floor_mesh(float half, float height = 0) {
    return quad({-half, height, half}, {2 * half, 0, 0}, {0, 0, -2 * half});
}

inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const glm::uvec3& t : more.triangles)
        mesh.triangles.push_back(t + first);
}

/// A closed cube about the origin with its faces turned outward; one mesh, shared corners.
inline TriangleMesh cube_mesh(float half) {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i)
        mesh.positions.push_back(half * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// A unit sphere seen from inside, cut open above the height y = `rim`; `rings` x 2 `rings` quads.
inline TriangleMesh bowl_mesh(double rim, int rings) {
    TriangleMesh mesh;
    const int columns = 2 * rings;
    const auto vertex = [&](int ring, int column) {
        return std::uint32_t(ring * columns + column % columns);
    };
    for (int i = 0; i <= rings; ++i) {
        const double polar = std::acos(rim) + (std::numbers::pi - std::acos(rim)) * i / rings;
        for (int j = 0; j < columns; ++j) {
            const double turn = 2 * std::numbers::pi * j / columns;
            mesh.positions.emplace_back(std::sin(polar) * std::cos(turn), std::cos(polar),
                                        std::sin(polar) * std::sin(turn));
        }
    }
    for (int i = 0; i < rings; ++i) {
        for (int j = 0; j < columns; ++j) {
            mesh.triangles.emplace_back(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j));
            mesh.triangles.emplace_back(vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j));
        }
    }
    return mesh;
}

inline SceneObject object_of(std::variant<MeshShape, SphereShape> shape, Material material,
                             const glm::dmat4& world_from_object, bool real) {
    return {"object", {{std::move(shape), std::move(material)}}, {{0, world_from_object}}, real};
}

inline SceneObject mesh_object(TriangleMesh mesh, Material material, bool real = false) {
    return object_of(MeshShape{std::make_shared<TriangleMesh>(std::move(mesh))},
                     std::move(material), glm::dmat4(1.0), real);
}

inline SceneObject sphere_object(const glm::dvec3& centre, float radius, Material material,
                                 bool real = false) {
    glm::dmat4 world_from_object(1.0);
    world_from_object[3] = glm::dvec4(centre, 1);
    return object_of(SphereShape{radius}, std::move(material), world_from_object, real);
}

inline EnvironmentSampler environment_of(Image<Rgb> radiance) {
    return make_environment_sampler({std::move(radiance), glm::dmat3(1.0)});
}

inline EnvironmentSampler constant_environment(float radiance) {
    return environment_of(Image<Rgb>(16, 8, Rgb(radiance)));
}

/// `above` from every direction with y > 0 and `below` from the others.
inline EnvironmentSampler half_environment(float above, float below) {
    Image<Rgb> map(16, 8, Rgb(below));
    for (int y = 0; y < map.height / 2; ++y)
        for (int x = 0; x < map.width; ++x)
            map(x, y) = Rgb(above);
    return environment_of(std::move(map));
}

/// An ambient `base` and a spherical Gaussian lobe of peak `peak` about a unit direction.
inline Image<Rgb> lobe_map(const glm::dvec3& axis, double sharpness, float base, const Rgb& peak) {
    Image<Rgb> map(64, 32);
    for (int y = 0; y < map.height; ++y) {
        for (int x = 0; x < map.width; ++x) {
            const glm::dvec3 d = direction_from_texel(map, {x + 0.5, y + 0.5});
            map(x, y) = Rgb(base) + peak * float(std::exp(sharpness * (glm::dot(axis, d) - 1)));
        }
    }
    return map;
}

/// All zero but one texel.
inline Image<Rgb> hot_pixel_map(int x, int y, float radiance, float base = 0) {
    Image<Rgb> map(32, 16, Rgb(base));
    map(x, y) = Rgb(radiance);
    return map;
}

/// A camera at `eye` that looks at `target`, its image's upper edge towards `up`.
inline Pose look_at(const glm::dvec3& eye, const glm::dvec3& target,
                    const glm::dvec3& up = {0, 1, 0}) {
    const glm::dvec3 z = glm::normalize(target - eye);
    const glm::dvec3 x = glm::normalize(glm::cross(z, up));
    return {glm::dmat3(x, glm::cross(z, x), z), eye};
}

/// A lens whose optical axis passes through the middle of the image.
inline Lens lens_of(int width, int height, double focal_length) {
    return {width, height, focal_length, focal_length, 0.5 * (width - 1), 0.5 * (height - 1)};
}

/// A lens so long that all pixels see the same point, each with random numbers of its own.
inline Lens telescope(int width, int height) { return lens_of(width, height, 1e5); }

/// A scene's exact geometry, placed; real and virtual objects apart and together.
struct PlacedScene {
    EmbreeSceneCache cache;
    EmbreeScene real, virtual_, all;

    explicit PlacedScene(std::vector<SceneObject> objects) {
        const VirtualScene scene{std::move(objects)};
        real = cache.place(scene, 0, true);
        virtual_ = cache.place(scene, 0, false);
        all = cache.place(scene, 0);
    }
};

/// Dimension at which random numbers of the path tracer behind real geometry start.
inline constexpr std::uint32_t real_light_dimension = 64;

/// The two-mode sampler over a scene with exact real objects.
inline TwoModeResult sample_scene(const PlacedScene& scene, const EnvironmentSampler& environment,
                                  const Lens& lens, const Pose& world_from_camera,
                                  const SamplingSettings& settings, std::uint32_t frame = 0) {
    const RealGeometry real = exact_real_geometry(scene.real, environment, real_light_dimension);
    return sample_two_modes({lens, world_from_camera, real, scene.virtual_, environment}, settings,
                            frame);
}

/// 576 estimates of the light at the point in the middle of the view, side by side: 16 frames of 36
/// pixels, few enough that hardly two pixels of a frame share a light net.
inline NoisyLayers sample_point(const PlacedScene& scene, const EnvironmentSampler& environment,
                                const Pose& world_from_camera, const SamplingSettings& settings) {
    constexpr int side = 6, frames = 16;
    const Lens lens = telescope(side, side);
    NoisyLayers all = sample_scene(scene, environment, lens, world_from_camera, settings).layers;
    const auto append_pixels = [](auto& to, const auto& from) {
        to.pixels.insert(to.pixels.end(), from.pixels.begin(), from.pixels.end());
        to.height += from.height;
    };
    for (std::uint32_t frame = 1; frame < frames; ++frame) {
        const NoisyLayers more =
            sample_scene(scene, environment, lens, world_from_camera, settings, frame).layers;
        append_pixels(all.m, more.m);
        append_pixels(all.k_v, more.k_v);
        append_pixels(all.s_rv, more.s_rv);
        for (Irradiance NoisyLayers::*light : {&NoisyLayers::direct, &NoisyLayers::indirect})
            for (Image<Rgb> Irradiance::*layer :
                 {&Irradiance::e_r, &Irradiance::e_rv_real, &Irradiance::e_rv_virtual})
                append_pixels(all.*light.*layer, more.*light.*layer);
    }
    return all;
}

/// Radiance of one path per lane along the same ray; lanes differ in their random numbers.
inline RadiancePacket paths_along(const EmbreeScene& scene, const EnvironmentSampler& environment,
                                  const glm::vec3& origin, const glm::vec3& direction,
                                  std::uint32_t sample, const PathSettings& settings = {}) {
    RayPacket rays;
    SampleKeys keys;
    for (int lane = 0; lane < packet_width; ++lane) {
        rays.set(lane, origin, glm::normalize(direction));
        keys[std::size_t(lane)] = {7, 0, std::uint32_t(lane), sample};
    }
    return trace_paths(scene, environment, rays, keys, settings);
}

}  // namespace inlay::test
