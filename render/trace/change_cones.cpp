#include "render/trace/change_cones.h"

#include "recordings/base/check.h"

#include <Eigen/Core>

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

/// As many cones as the processor works on at once.
using Eight = Eigen::Array<float, 8, 1>;
constexpr std::size_t lanes = Eight::RowsAtCompileTime;
static_assert(most_change_cones % lanes == 0);

Eigen::Map<Eight> lanes_at(float* plane) { return Eigen::Map<Eight>(plane); }
Eigen::Map<const Eight> lanes_at(const float* plane) { return Eigen::Map<const Eight>(plane); }

/// Spheres as a point sees them, in planes.
struct SeenSpheres {
    using Plane = std::array<float, most_change_cones>;
    Plane axis_x, axis_y, axis_z, radius, distance;
    Plane above;   // m over the horizon, of the centre
    Plane height;  // as in ChangeCones; 1 for spheres that hold the point
    Plane cosine;  // to the normal: the largest within the cone
};

/// What is seen of a sphere from a point is seen from another one of a sphere that is larger by the
/// way between them.
void look_at(std::span<const BoundingSphere> spheres, const glm::vec3& position,
             const glm::vec3& normal, float reach, SeenSpheres& seen) {
    for (std::size_t i = 0; i < spheres.size() || i % lanes != 0; ++i) {
        const BoundingSphere sphere = i < spheres.size() ? spheres[i] : BoundingSphere{position, 0};
        seen.axis_x[i] = sphere.centre.x - position.x;
        seen.axis_y[i] = sphere.centre.y - position.y;
        seen.axis_z[i] = sphere.centre.z - position.z;
        seen.radius[i] = (sphere.radius + reach) * rounding_margin;
    }
    for (std::size_t i = 0; i < spheres.size(); i += lanes) {
        const Eight x = lanes_at(&seen.axis_x[i]), y = lanes_at(&seen.axis_y[i]),
                    z = lanes_at(&seen.axis_z[i]), radius = lanes_at(&seen.radius[i]);
        const Eight above = normal.x * x + normal.y * y + normal.z * z;
        const Eight distance = (x * x + y * y + z * z).sqrt();
        const Eight divisor = distance.max(no_distance);
        const Eight sine = radius / divisor.max(radius);
        const Eight height = sine * sine / (1 + ((1 - sine) * (1 + sine)).sqrt());
        // Largest cosine within a cone, whose half angle is below 90 degrees, from its axis's.
        const Eight c = above / divisor, inner = 1 - height;
        const Eight apart = (1 - c * c).max(0.0f).sqrt() * (1 - inner * inner).max(0.0f).sqrt();
        lanes_at(&seen.axis_x[i]) = x / divisor;
        lanes_at(&seen.axis_y[i]) = y / divisor;
        lanes_at(&seen.axis_z[i]) = z / divisor;
        lanes_at(&seen.distance[i]) = distance;
        lanes_at(&seen.above[i]) = above;
        lanes_at(&seen.height[i]) = height;
        lanes_at(&seen.cosine[i]) =
            (c >= inner).select(Eight::Ones(), (c * inner + apart).max(0.0f));
    }
}

constexpr float anywhere = 2;

/// Sets the cone that holds all circular ones, which are padded.
void enclose(ChangeCones& cones) {
    const auto count = std::size_t(cones.count);
    cones.middle_height = anywhere;
    cones.middle = glm::vec3(0);
    if (count == 0 || cones.hemisphere > 0) return;
    for (std::size_t i = 0; i < count; ++i)
        cones.middle += glm::vec3(cones.axis_x[i], cones.axis_y[i], cones.axis_z[i]);
    const float length = glm::length(cones.middle);
    if (!(length > 0.1f)) return;  // they stand all around
    cones.middle /= length;
    Eight least = Eight::Ones();  // cosine of the angle to the far side of a cone
    for (std::size_t i = 0; i < count; i += lanes) {
        const Eight height = lanes_at(&cones.height[i]), down = height.max(0.0f);
        const Eight x = cones.middle.x - lanes_at(&cones.axis_x[i]),
                    y = cones.middle.y - lanes_at(&cones.axis_y[i]),
                    z = cones.middle.z - lanes_at(&cones.axis_z[i]);
        const Eight square = x * x + y * y + z * z;  // of the chord: exact for small angles
        const Eight to_axis = 1 - 0.5f * square;
        const Eight sine = (square * (1 - 0.25f * square)).max(0.0f).sqrt();
        const Eight far_side = to_axis * (1 - down) - sine * (down * (2 - down)).sqrt();
        const Eight cosine = (to_axis > 0.0f).select(far_side, -Eight::Ones());
        least = (height >= 0.0f).select(least.min(cosine), least);
    }
    const float furthest = least.minCoeff();
    if (furthest > -1) cones.middle_height = (1 - furthest) * rounding_margin + 1e-6f;
}

}  // namespace

void find_cones(std::span<const BoundingSphere> spheres, const glm::vec3& position,
                const glm::vec3& normal, float reach, ChangeCones& cones) {
    require(spheres.size() <= std::size_t(most_change_cones), "more bounds than change cones");
    SeenSpheres seen;
    look_at(spheres, position, normal, reach, seen);
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
    for (std::size_t i = count; i % lanes != 0; ++i) {
        cones.axis_x[i] = cones.axis_y[i] = cones.axis_z[i] = cones.density[i] = 0;
        cones.height[i] = -1;
    }
    enclose(cones);
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
    Eight sum = Eight::Zero();
    for (std::size_t i = 0; i < std::size_t(cones.count); i += lanes) {
        const Eight x = direction.x - lanes_at(&cones.axis_x[i]),
                    y = direction.y - lanes_at(&cones.axis_y[i]),
                    z = direction.z - lanes_at(&cones.axis_z[i]);
        // 1 - cosine as half the squared distance of unit vectors: exact for narrow cones
        const auto within = 0.5f * (x * x + y * y + z * z) <= lanes_at(&cones.height[i]);
        sum += within.select(lanes_at(&cones.density[i]), Eight::Zero());
    }
    return sum.sum() + cones.hemisphere * std::max(0.0f, glm::dot(cones.normal, direction)) / pi;
}

}  // namespace inlay
