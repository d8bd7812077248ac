#include "render/scatter/bsdf.h"

#include "render/scatter/ggx.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

int wrapped(int i, int size) {
    const int r = i % size;
    return r < 0 ? r + size : r;
}

Rgb look_up(const Texture& texture, glm::vec2 uv) {
    if (!(std::abs(uv.x) < 1e6f && std::abs(uv.y) < 1e6f)) return texture(0, 0);
    const float x = (uv.x - std::floor(uv.x)) * float(texture.width) - 0.5f;
    const float y = (uv.y - std::floor(uv.y)) * float(texture.height) - 0.5f;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const float tx = x - float(x0), ty = y - float(y0);
    const auto texel = [&](int i, int j) {
        return texture(wrapped(i, texture.width), wrapped(j, texture.height));
    };
    return glm::mix(glm::mix(texel(x0, y0), texel(x0 + 1, y0), tx),
                    glm::mix(texel(x0, y0 + 1), texel(x0 + 1, y0 + 1), tx), ty);
}

Rgb textured(const Rgb& factor, const std::shared_ptr<const Texture>& texture, glm::vec2 uv) {
    return texture && !texture->empty() ? factor * look_up(*texture, uv) : factor;
}

/// Where a material is looked up.
struct MaterialPoint {
    glm::vec2 uv;
    float viewer_cosine;
    Rgb vertex_color;
};

Bsdf at(const Diffuse& m, const MaterialPoint& point) {
    const Rgb albedo = textured(m.reflectance, m.texture, point.uv);
    if (!m.vertex_colors) return {albedo, std::nullopt};
    return {albedo * glm::clamp(point.vertex_color, 0.0f, 1.0f), std::nullopt};
}

Bsdf at(const Phong& m, const MaterialPoint& point) {
    return {textured(m.diffuse, m.texture, point.uv), PhongLobe{m.specular, m.exponent}};
}

Bsdf at(const Ggx& m, const MaterialPoint& point) {
    const Rgb base = textured(m.base_color, m.texture, point.uv);
    constexpr float dielectric = 0.04f;  // reflectance at normal incidence
    const Rgb f0 = glm::mix(Rgb(dielectric), base, m.metallic);
    const float grazing = std::pow(1 - std::clamp(point.viewer_cosine, 0.0f, 1.0f), 5.0f);
    const float refracted = (1 - dielectric) * (1 - grazing);
    const glm::vec2 alpha = glm::max(m.roughness * m.roughness, glm::vec2(1e-3f));
    return {base * (1 - m.metallic) * refracted, GgxLobe{f0, alpha}};
}

glm::vec3 mirror_direction(const ScatterFrame& frame) {
    const glm::vec3& n = frame.world_from_local[2];
    return 2 * glm::dot(n, frame.towards_viewer) * n - frame.towards_viewer;
}

Rgb eval(const PhongLobe& lobe, const ScatterFrame& frame, const glm::vec3& towards_light) {
    const float cosine = std::max(0.0f, glm::dot(frame.world_from_local[2], towards_light));
    const float c = std::clamp(glm::dot(mirror_direction(frame), towards_light), 0.0f, 1.0f);
    return lobe.specular * ((lobe.exponent + 2) / (2 * pi) * std::pow(c, lobe.exponent) * cosine);
}

DirectionSample sample(const PhongLobe& lobe, const ScatterFrame& frame, glm::vec2 u) {
    const DirectionSample local = sample_cosine_power(u, lobe.exponent);
    const glm::vec3 direction = basis_about(mirror_direction(frame)) * local.direction;
    const bool above = glm::dot(direction, frame.world_from_local[2]) > 0;
    return {direction, above ? local.pdf : 0.0f};
}

float pdf(const PhongLobe& lobe, const ScatterFrame& frame, const glm::vec3& towards_light) {
    if (glm::dot(frame.world_from_local[2], towards_light) <= 0) return 0;
    const float c = std::clamp(glm::dot(mirror_direction(frame), towards_light), 0.0f, 1.0f);
    return pdf_cosine_power({0, 0, c}, lobe.exponent);
}

Rgb eval(const GgxLobe& lobe, const ScatterFrame& frame, const glm::vec3& towards_light) {
    const glm::mat3 local_from_world = glm::transpose(frame.world_from_local);
    return eval_ggx(lobe.f0, lobe.alpha, local_from_world * frame.towards_viewer,
                    local_from_world * towards_light);
}

DirectionSample sample(const GgxLobe& lobe, const ScatterFrame& frame, glm::vec2 u) {
    const glm::mat3 local_from_world = glm::transpose(frame.world_from_local);
    const DirectionSample local =
        sample_ggx(lobe.alpha, local_from_world * frame.towards_viewer, u);
    return {frame.world_from_local * local.direction, local.pdf};
}

float pdf(const GgxLobe& lobe, const ScatterFrame& frame, const glm::vec3& towards_light) {
    const glm::mat3 local_from_world = glm::transpose(frame.world_from_local);
    return pdf_ggx(lobe.alpha, local_from_world * frame.towards_viewer,
                   local_from_world * towards_light);
}

/// Exponent n of the cosine power about the mirror direction that is as wide as the lobe.
float equivalent_exponent(const PhongLobe& lobe) { return lobe.exponent; }

/// Near its peak a GGX lobe in the half vector is cos^(2/alpha^2); reflection doubles angles.
float equivalent_exponent(const GgxLobe& lobe) { return 0.5f / (lobe.alpha.x * lobe.alpha.y); }

}  // namespace

Bsdf bsdf_at(const Material& material, glm::vec2 uv, float viewer_cosine, const Rgb& vertex_color) {
    const MaterialPoint point{uv, viewer_cosine, vertex_color};
    return std::visit([&](const auto& m) { return at(m, point); }, material);
}

ScatterFrame scatter_frame(const glm::vec3& normal, const glm::vec3& towards_viewer) {
    const bool behind = glm::dot(normal, towards_viewer) < 0;
    return {basis_about(behind ? -normal : normal), towards_viewer};
}

Rgb eval_glossy(const Bsdf& bsdf, const ScatterFrame& frame, const glm::vec3& towards_light) {
    if (!bsdf.glossy) return Rgb(0);
    return std::visit([&](const auto& lobe) { return eval(lobe, frame, towards_light); },
                      *bsdf.glossy);
}

DirectionSample sample_glossy(const Bsdf& bsdf, const ScatterFrame& frame, glm::vec2 u) {
    if (!bsdf.glossy) return {};
    return std::visit([&](const auto& lobe) { return sample(lobe, frame, u); }, *bsdf.glossy);
}

float pdf_glossy(const Bsdf& bsdf, const ScatterFrame& frame, const glm::vec3& towards_light) {
    if (!bsdf.glossy) return 0;
    return std::visit([&](const auto& lobe) { return pdf(lobe, frame, towards_light); },
                      *bsdf.glossy);
}

float glossy_bandwidth(const Bsdf& bsdf) {
    if (!bsdf.glossy) return 0;
    const float exponent =
        std::visit([](const auto& lobe) { return equivalent_exponent(lobe); }, *bsdf.glossy);
    return 1.82f * std::sqrt(exponent);
}

}  // namespace inlay
