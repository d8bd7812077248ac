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

/// Below this (m) a distance does not divide.
constexpr float no_distance = 1e-30f;

constexpr std::size_t simd_width = 8;
static_assert(most_change_cones % simd_width == 0);

/// Spheres as a point sees them, in planes: written without branches, for several at a time.
struct SeenSpheres {
    using Plane = std::array<float, most_change_cones>;
    Plane axis_x, axis_y, axis_z, radius, distance;
    Plane above;   // m over the horizon, of the centre
    Plane height;  // as in ChangeCones; 1 for spheres that hold the point
    Plane cosine;  // to the normal: the largest within the cone
};

void look_at(std::span<const BoundingSphere> spheres, const glm::vec3& position,
             const glm::vec3& normal, SeenSpheres& seen) {
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const float x = spheres[i].centre.x - position.x, y = spheres[i].centre.y - position.y,
                    z = spheres[i].centre.z - position.z;
        const float radius = spheres[i].radius * rounding_margin;
        const float above = normal.x * x + normal.y * y + normal.z * z;
        const float distance = std::sqrt(x * x + y * y + z * z);
        const float divisor = std::max(distance, no_distance);
        const float sine = radius / std::max(divisor, radius);
        const float height = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
        // Largest cosine within a cone, whose half angle is below 90 degrees, from its axis's.
        const float c = above / divisor, inner = 1 - height;
        const float apart =
            std::sqrt(std::max(0.0f, 1 - c * c)) * std::sqrt(std::max(0.0f, 1 - inner * inner));
        seen.axis_x[i] = x / divisor, seen.axis_y[i] = y / divisor, seen.axis_z[i] = z / divisor;
        seen.radius[i] = radius, seen.distance[i] = distance, seen.above[i] = above;
        seen.height[i] = height;
        seen.cosine[i] = c >= inner ? 1.0f : std::max(0.0f, c * inner + apart);
    }
}

}  // namespace

void find_cones(std::span<const BoundingSphere> spheres, const glm::vec3& position,
                const glm::vec3& normal, ChangeCones& cones) {
    require(spheres.size() <= std::size_t(most_change_cones), "more bounds than change cones");
    SeenSpheres seen;
    look_at(spheres, position, normal, seen);
    cones.normal = normal;
    bool held = false;
    float sum = 0;  // bound of the irradiance of an even sky of radiance 1, over 2 pi
    std::size_t count = 0;
    for (std::size_t s = 0; s < spheres.size(); ++s) {
        if (!(seen.above[s] + seen.radius[s] > 0)) continue;
        if (seen.radius[s] >= seen.distance[s]) {
            held = true;
            continue;
        }
        const float weight = seen.height[s] * seen.cosine[s];
        if (!(weight > 0)) continue;
        cones.axis_x[count] = seen.axis_x[s];
        cones.axis_y[count] = seen.axis_y[s];
        cones.axis_z[count] = seen.axis_z[s];
        cones.height[count] = seen.height[s];
        cones.below[count] = sum;
        cones.density[count] = seen.cosine[s];
        sum += weight;
        ++count;
    }
    cones.count = int(count);
    const float hemisphere = held ? 0.5f : 0.0f;
    const float total = sum + hemisphere;
    cones.fill = std::min(1.0f, 2 * total);
    cones.hemisphere = held ? hemisphere / total : 0.0f;
    for (std::size_t i = 0; i < count; ++i) {
        cones.below[i] = (hemisphere + cones.below[i]) / total;
        cones.density[i] /= 2 * pi * total;
    }
    for (std::size_t i = count; i % simd_width != 0; ++i) {
        cones.axis_x[i] = cones.axis_y[i] = cones.axis_z[i] = cones.density[i] = 0;
        cones.height[i] = -1;
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
    const glm::vec3 direction =
        glm::normalize(basis_about({cones.axis_x[i], cones.axis_y[i], cones.axis_z[i]}) * local);
    return {direction, pdf_cones(cones, direction)};
}

float pdf_cones(const ChangeCones& cones, const glm::vec3& direction) {
    std::array<float, simd_width> sums{};
    for (std::size_t first = 0; first < std::size_t(cones.count); first += simd_width) {
        for (std::size_t k = 0; k < simd_width; ++k) {
            const std::size_t i = first + k;
            // 1 - cosine as half the squared distance of unit vectors: exact for narrow cones
            const float x = direction.x - cones.axis_x[i], y = direction.y - cones.axis_y[i],
                        z = direction.z - cones.axis_z[i];
            const bool within = 0.5f * (x * x + y * y + z * z) <= cones.height[i];
            sums[k] += within ? cones.density[i] : 0.0f;
        }
    }
    for (std::size_t half = simd_width / 2; half > 0; half /= 2)
        for (std::size_t k = 0; k < half; ++k)
            sums[k] += sums[k + half];
    return sums[0] + cones.hemisphere * std::max(0.0f, glm::dot(cones.normal, direction)) / pi;
}

}  // namespace inlay
