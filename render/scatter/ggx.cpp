#include "render/scatter/ggx.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// A = sqrt(z^2 + (ax x)^2 + (ay y)^2): Smith's masking without a division by z.
float stretched_length(glm::vec2 alpha, const glm::vec3& w) {
    return std::sqrt(w.z * w.z + alpha.x * alpha.x * w.x * w.x + alpha.y * alpha.y * w.y * w.y);
}

/// The distribution of normals, 1/sr. In double: its peak is 1 / (pi alpha^2).
double distribution(glm::vec2 alpha, const glm::vec3& h) {
    const double x = double(h.x) / alpha.x, y = double(h.y) / alpha.y, z = h.z;
    const double q = x * x + y * y + z * z;
    return 1 / (std::numbers::pi * alpha.x * alpha.y * q * q);
}

/// The normal between two directions above the surface; opposite ones at the horizon have +z.
glm::vec3 half_vector(const glm::vec3& viewer, const glm::vec3& light) {
    const glm::vec3 sum = viewer + light;
    return glm::dot(sum, sum) > 0 ? glm::normalize(sum) : glm::vec3(0, 0, 1);
}

float masking_viewer(glm::vec2 alpha, const glm::vec3& viewer) {
    return 2 * viewer.z / (viewer.z + stretched_length(alpha, viewer));
}

glm::vec3 sample_visible_normal(glm::vec2 alpha, const glm::vec3& viewer, glm::vec2 u) {
    const glm::vec3 v = glm::normalize(glm::vec3(alpha.x * viewer.x, alpha.y * viewer.y, viewer.z));
    const float length2 = v.x * v.x + v.y * v.y;
    const glm::vec3 t1 =
        length2 > 0 ? glm::vec3(-v.y, v.x, 0) / std::sqrt(length2) : glm::vec3(1, 0, 0);
    const glm::vec3 t2 = glm::cross(v, t1);
    const float radius = std::sqrt(u.x), angle = 2 * pi * u.y;
    const float a = radius * std::cos(angle);
    const float s = 0.5f * (1 + v.z);
    const float b = (1 - s) * std::sqrt(std::max(0.0f, 1 - a * a)) + s * radius * std::sin(angle);
    const glm::vec3 h = a * t1 + b * t2 + std::sqrt(std::max(0.0f, 1 - a * a - b * b)) * v;
    return glm::normalize(glm::vec3(alpha.x * h.x, alpha.y * h.y, std::max(1e-6f, h.z)));
}

}  // namespace

Rgb eval_ggx(const Rgb& f0, glm::vec2 alpha, const glm::vec3& viewer, const glm::vec3& light) {
    if (viewer.z <= 0 || light.z <= 0) return Rgb(0);
    const glm::vec3 h = half_vector(viewer, light);
    const float fresnel = std::pow(std::max(0.0f, 1 - glm::dot(viewer, h)), 5.0f);
    // G2 / (4 cos_o cos_i) * cos_i, with the cosines cancelled
    const float masked =
        0.5f * light.z /
        (viewer.z * stretched_length(alpha, light) + light.z * stretched_length(alpha, viewer));
    return (f0 + (Rgb(1) - f0) * fresnel) * float(distribution(alpha, h) * masked);
}

DirectionSample sample_ggx(glm::vec2 alpha, const glm::vec3& viewer, glm::vec2 u) {
    if (viewer.z <= 0) return {glm::vec3(0, 0, 1), 0};
    const glm::vec3 h = sample_visible_normal(alpha, viewer, u);
    const glm::vec3 light = glm::normalize(2 * glm::dot(viewer, h) * h - viewer);
    return {light, pdf_ggx(alpha, viewer, light)};
}

float pdf_ggx(glm::vec2 alpha, const glm::vec3& viewer, const glm::vec3& light) {
    if (viewer.z <= 0 || light.z <= 0) return 0;
    const glm::vec3 h = half_vector(viewer, light);
    return float(masking_viewer(alpha, viewer) * distribution(alpha, h) / (4 * viewer.z));
}

}  // namespace inlay
