#include "render/sample/warp.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

constexpr float pi = std::numbers::pi_v<float>;

/// Angle of (x, y) as a share of the full turn, in [0, 1).
float turn_of(const glm::vec3& d) {
    const float turn = std::atan2(d.y, d.x) / (2 * pi);
    return std::min(turn < 0 ? turn + 1 : turn, std::nextafter(1.0f, 0.0f));
}

}  // namespace

DirectionSample sample_cosine_hemisphere(glm::vec2 u) {
    const float radius = std::sqrt(u.x);
    const float angle = 2 * pi * u.y;
    const float z = std::sqrt(1 - u.x);  // > 0, since u.x < 1
    return {{radius * std::cos(angle), radius * std::sin(angle), z}, z / pi};
}

float pdf_cosine_hemisphere(const glm::vec3& direction) { return std::max(direction.z, 0.0f) / pi; }

glm::vec2 invert_cosine_hemisphere(const glm::vec3& d) {
    return {d.x * d.x + d.y * d.y, turn_of(d)};
}

DirectionSample sample_cosine_power(glm::vec2 u, float exponent) {
    const float z = std::pow(1 - u.x, 1 / (exponent + 1));
    const float radius = std::sqrt(std::max(0.0f, (1 - z) * (1 + z)));
    const float angle = 2 * pi * u.y;
    return {{radius * std::cos(angle), radius * std::sin(angle), z},
            (exponent + 1) / (2 * pi) * std::pow(z, exponent)};
}

float pdf_cosine_power(const glm::vec3& direction, float exponent) {
    if (direction.z <= 0) return 0;
    return (exponent + 1) / (2 * pi) * std::pow(direction.z, exponent);
}

glm::vec2 invert_cosine_power(const glm::vec3& d, float exponent) {
    return {1 - std::pow(d.z, exponent + 1), turn_of(d)};
}

glm::mat3 basis_about(const glm::vec3& z) {
    const float sign = std::copysign(1.0f, z.z);
    const float a = -1 / (sign + z.z);
    const float b = z.x * z.y * a;
    return {{1 + sign * z.x * z.x * a, sign * b, -sign * z.x}, {b, sign + z.y * z.y * a, -z.y}, z};
}

}  // namespace inlay
