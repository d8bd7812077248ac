#include "render/trace/change_cones.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Spheres count as this much larger, so that rounding leaves no direction out.
constexpr float rounding_margin = 1 + 1e-4f;

/// Largest cosine to the normal within a cone whose axis has the cosine `c`, half angle < 90
/// degrees.
float largest_cosine(float c, float height) {
    const float inner = 1 - height;
    if (c >= inner) return 1;
    const auto sine = [](float cosine) { return std::sqrt(std::max(0.0f, 1 - cosine * cosine)); };
    return std::max(0.0f, c * inner + sine(c) * sine(inner));
}

}  // namespace

void find_cones(std::span<const BoundingSphere> spheres, const glm::vec3& position,
                const glm::vec3& normal, ChangeCones& cones) {
    require(spheres.size() <= std::size_t(most_change_cones), "more bounds than change cones");
    cones.count = 0;
    cones.normal = normal;
    bool held = false;
    float sum = 0;  // bound of the irradiance of an even sky of radiance 1, over 2 pi
    for (const BoundingSphere& sphere : spheres) {
        const auto i = std::size_t(cones.count);
        const glm::vec3 to_centre = sphere.centre - position;
        const float radius = sphere.radius * rounding_margin;
        const float above = glm::dot(normal, to_centre);
        if (!(above + radius > 0)) continue;
        const float distance = glm::length(to_centre);
        if (radius >= distance) {
            held = true;
            continue;
        }
        const float sine = radius / distance;
        cones.axis[i] = to_centre / distance;
        cones.height[i] = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
        const float cosine = largest_cosine(above / distance, cones.height[i]);
        const float weight = cones.height[i] * cosine;
        if (!(weight > 0)) continue;
        cones.below[i] = sum;
        cones.density[i] = cosine;
        sum += weight;
        ++cones.count;
    }
    const float hemisphere = held ? 0.5f : 0.0f;
    const float total = sum + hemisphere;
    cones.fill = std::min(1.0f, 2 * total);
    cones.hemisphere = held ? hemisphere / total : 0.0f;
    for (std::size_t i = 0; i < std::size_t(cones.count); ++i) {
        cones.below[i] = (hemisphere + cones.below[i]) / total;
        cones.density[i] /= 2 * pi * total;
    }
}

DirectionSample sample_cones(const ChangeCones& cones, glm::vec2 u) {
    if (cones.empty()) return {};
    if (u.x < cones.hemisphere || cones.count == 0) {
        const glm::vec3 local = sample_cosine_hemisphere({u.x / cones.hemisphere, u.y}).direction;
        const glm::vec3 direction = basis_about(cones.normal) * local;
        return {direction, pdf_cones(cones, direction)};
    }
    const auto end = cones.below.begin() + cones.count;
    const auto i =
        std::size_t(std::upper_bound(cones.below.begin() + 1, end, u.x) - cones.below.begin() - 1);
    const float next = int(i) + 1 < cones.count ? cones.below[i + 1] : 1.0f;
    const float within = std::clamp((u.x - cones.below[i]) / (next - cones.below[i]), 0.0f, 1.0f);
    const float down = within * cones.height[i];  // 1 - cosine
    const float sine = std::sqrt(std::max(0.0f, down * (2 - down)));
    const float around = 2 * pi * u.y;
    const glm::vec3 local{sine * std::cos(around), sine * std::sin(around), 1 - down};
    const glm::vec3 direction = glm::normalize(basis_about(cones.axis[i]) * local);
    return {direction, pdf_cones(cones, direction)};
}

float pdf_cones(const ChangeCones& cones, const glm::vec3& direction) {
    float density = cones.hemisphere * std::max(0.0f, glm::dot(cones.normal, direction)) / pi;
    for (std::size_t i = 0; i < std::size_t(cones.count); ++i) {
        // 1 - cosine as half the squared distance of unit vectors: exact for narrow cones
        const glm::vec3 apart = direction - cones.axis[i];
        if (0.5f * glm::dot(apart, apart) <= cones.height[i]) density += cones.density[i];
    }
    return density;
}

}  // namespace inlay
