#include "recordings/base/environment_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {

using std::numbers::pi;

glm::dvec2 texel_from_direction(const Image<Rgb>& map, const glm::dvec3& d) {
    const double polar = std::atan2(std::hypot(d.x, d.z), d.y);
    const double longitude = std::atan2(d.x, d.z);  // 0 along +z, pi/2 along +x
    double u = 0.5 - longitude / (2 * pi);
    u -= std::floor(u);
    const double x = std::min(u * map.width, std::nextafter(double(map.width), 0.0));
    return {x, std::clamp(polar / pi, 0.0, 1.0) * map.height};
}

glm::dvec3 direction_from_texel(const Image<Rgb>& map, const glm::dvec2& texel) {
    const double polar = pi * texel.y / map.height;
    const double longitude = 2 * pi * (0.5 - texel.x / map.width);
    return {std::sin(polar) * std::sin(longitude), std::cos(polar),
            std::sin(polar) * std::cos(longitude)};
}

double texel_solid_angle(const Image<Rgb>& map, int y) {
    const double top = pi * y / map.height;
    const double bottom = pi * (y + 1) / map.height;
    return (std::cos(top) - std::cos(bottom)) * 2 * pi / map.width;
}

Rgb radiance_from(const EnvironmentMap& environment, const glm::vec3& direction_world) {
    const Image<Rgb>& map = environment.radiance;
    const glm::dvec3 d =
        glm::transpose(environment.world_from_environment) * glm::dvec3(direction_world);
    const glm::dvec2 texel = texel_from_direction(map, d);
    return map(std::min(int(texel.x), map.width - 1), std::min(int(texel.y), map.height - 1));
}

}  // namespace inlay
