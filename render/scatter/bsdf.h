// Bsdf: a material at a point, and the three things a tracer asks of it: value, sample, density.
#pragma once

#include "render/sample/warp.h"
#include "render/scene/material.h"

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

/// Cosine-power lobe about the mirror direction; see Phong.
struct PhongLobe {
    Rgb specular{0.0f};
    float exponent = 1;
};

/// GGX reflection with visible-normal sampling (Heitz 2018) and Schlick's Fresnel term.
struct GgxLobe {
    Rgb f0{0.04f};          // reflectance at normal incidence
    glm::vec2 alpha{0.5f};  // along the two tangents, >= 1e-3
};

/// A material with its textures looked up: a Lambertian part and, perhaps, a glossy lobe.
struct Bsdf {
    Rgb diffuse{0.0f};  // albedo, 0..1
    std::optional<std::variant<PhongLobe, GgxLobe>> glossy;
};

/// Directions at a surface point, all unit and pointing away from it.
struct ScatterFrame {
    glm::mat3 world_from_local{1.0f};  // third column: the shading normal, on the viewer's side
    glm::vec3 towards_viewer{0, 0, 1};
};

ScatterFrame scatter_frame(const glm::vec3& normal, const glm::vec3& towards_viewer);

/// `uv`: texture coordinates, (0, 0) = top left; repeats outside 0..1. Bilinear. `viewer_cosine`
/// (0..1) between normal and viewer: what a dielectric's surface reflects, by Schlick's Fresnel
/// term, does not reach its base. Taking the viewer's angle alone keeps the base Lambertian in the
/// light's direction, and the sum of both parts at most 1. `vertex_color`: linear, kept within
/// 0..1, for a material that asks for it.
Bsdf bsdf_at(const Material& material, glm::vec2 uv, float viewer_cosine,
             const Rgb& vertex_color = Rgb(1));

/// Glossy part of the BSDF times the cosine at the surface (1/sr); the diffuse part is albedo / pi.
Rgb eval_glossy(const Bsdf& bsdf, const ScatterFrame& frame, const glm::vec3& towards_light);

/// A direction drawn about the glossy lobe; pdf 0 where there is no lobe or it points below the
/// surface.
DirectionSample sample_glossy(const Bsdf& bsdf, const ScatterFrame& frame, glm::vec2 u);
float pdf_glossy(const Bsdf& bsdf, const ScatterFrame& frame, const glm::vec3& towards_light);

/// B_rho (1/rad): angular bandwidth of the glossy lobe that holds 99 % of its energy, 1.82 sqrt(n)
/// for cos^n; 0 without a lobe. GGX through the cosine power of the same width.
float glossy_bandwidth(const Bsdf& bsdf);

}  // namespace inlay
