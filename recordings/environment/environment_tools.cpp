#include "recordings/environment/environment_tools.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay {

using std::numbers::pi;

namespace {

constexpr int lobe_map_height = 128;  // texels

/// Mean of exp(sharpness (cos - 1)) over texel (x, y), by n x n points of equal solid angle.
double mean_over_texel(const Image<Rgb>& map, int x, int y, const GaussianLobe& lobe, int n) {
    const double reach = 2 * pi / map.height;  // more than half of a texel's diagonal
    const double centre = glm::dot(direction_from_texel(map, {x + 0.5, y + 0.5}), lobe.direction);
    const double nearest =
        std::cos(std::max(0.0, std::acos(std::clamp(centre, -1.0, 1.0)) - reach));
    if (lobe.sharpness * (nearest - 1) < -90) return 0;  // below the least float
    const double top = std::cos(pi * y / map.height), bottom = std::cos(pi * (y + 1) / map.height);
    double sum = 0;
    for (int j = 0; j < n; ++j) {
        const double polar = std::acos(std::clamp(top + (bottom - top) * (j + 0.5) / n, -1.0, 1.0));
        for (int i = 0; i < n; ++i) {
            const glm::dvec3 d =
                direction_from_texel(map, {x + (i + 0.5) / n, polar * map.height / pi});
            sum += std::exp(lobe.sharpness * (glm::dot(d, lobe.direction) - 1));
        }
    }
    return sum / (n * n);
}

/// Points a side that put at least ten into the lobe's width 1 / sqrt(sharpness).
int points_a_side(const GaussianLobe& lobe) {
    const double texel = pi / lobe_map_height;
    return std::max(2, int(std::ceil(10 * texel * std::sqrt(lobe.sharpness))));
}

/// The integral of the direction over a latitude-longitude rectangle (sr).
glm::dvec3 direction_integral(const Image<Rgb>& map, int x, int y) {
    const double t0 = pi * y / map.height, t1 = pi * (y + 1) / map.height;
    const double p1 = 2 * pi * (0.5 - double(x) / map.width);
    const double p0 = 2 * pi * (0.5 - double(x + 1) / map.width);
    const double ring = (t1 - t0) / 2 - (std::sin(2 * t1) - std::sin(2 * t0)) / 4;
    const double height = (std::sin(t1) * std::sin(t1) - std::sin(t0) * std::sin(t0)) / 2;
    return {ring * (std::cos(p0) - std::cos(p1)), height * (p1 - p0),
            ring * (std::sin(p1) - std::sin(p0))};
}

/// The integral of max(0, cos) over a texel that the horizon may cut (sr).
double cosine_integral(const Image<Rgb>& map, int x, int y, const glm::dvec3& normal) {
    constexpr int n = 32;
    const double texel = pi / map.height;
    const double centre = glm::dot(direction_from_texel(map, {x + 0.5, y + 0.5}), normal);
    const double reach = texel + 2 * pi / map.width;  // more than half of a texel's diagonal
    if (centre < -reach) return 0;
    if (centre > reach) return glm::dot(direction_integral(map, x, y), normal);
    const double top = std::cos(texel * y), bottom = std::cos(texel * (y + 1));
    double sum = 0;
    for (int j = 0; j < n; ++j) {
        const double polar = std::acos(std::clamp(top + (bottom - top) * (j + 0.5) / n, -1.0, 1.0));
        for (int i = 0; i < n; ++i)
            sum += std::max(0.0, glm::dot(normal, direction_from_texel(
                                                      map, {x + (i + 0.5) / n, polar / texel})));
    }
    return sum * texel_solid_angle(map, y) / (n * n);
}

}  // namespace

Image<Rgb> make_constant(const Rgb& radiance) { return Image<Rgb>(32, 16, radiance); }

Image<Rgb> make_lobes(const Rgb& ambient, const std::vector<GaussianLobe>& lobes) {
    Image<Rgb> map(2 * lobe_map_height, lobe_map_height, ambient);
    parallel_rows(map.height, [&](int y) {
        for (const GaussianLobe& lobe : lobes) {
            const int n = points_a_side(lobe);
            for (int x = 0; x < map.width; ++x)
                map(x, y) += lobe.radiance * float(mean_over_texel(map, x, y, lobe, n));
        }
    });
    return map;
}

Image<Rgb> scaled(const Image<Rgb>& radiance, float factor) {
    Image<Rgb> result = radiance;
    for (Rgb& texel : result.pixels)
        texel *= factor;
    return result;
}

glm::dmat3 align_environment(const glm::dvec3& up_world, const glm::dvec3& forward_world,
                             double rotate_deg) {
    const glm::dvec3 up = glm::normalize(up_world);
    const auto horizontal = [&](const glm::dvec3& v) { return v - glm::dot(v, up) * up; };
    glm::dvec3 forward{0};
    for (const glm::dvec3& v : {forward_world, glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0)}) {
        forward = horizontal(v);
        if (glm::length(forward) > 1e-6 * glm::length(v) && glm::length(v) > 0) break;
    }
    forward = glm::normalize(forward);
    const glm::dvec3 side = glm::cross(up, forward);
    const double angle = rotate_deg * pi / 180;
    return {std::cos(angle) * side - std::sin(angle) * forward, up,
            std::sin(angle) * side + std::cos(angle) * forward};
}

Rgb mean_radiance(const Image<Rgb>& map) {
    glm::dvec3 sum{0};
    for (int y = 0; y < map.height; ++y) {
        glm::dvec3 row{0};
        for (const Rgb& texel : map.row(y))
            row += glm::dvec3(texel);
        sum += row * texel_solid_angle(map, y);
    }
    return Rgb(sum / (4 * pi));
}

Rgb irradiance_from_environment(const EnvironmentMap& environment, const glm::dvec3& normal_world) {
    const Image<Rgb>& map = environment.radiance;
    const glm::dvec3 normal =
        glm::transpose(environment.world_from_environment) * normal_world;  // in the map's frame
    glm::dvec3 sum{0};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            sum += glm::dvec3(map(x, y)) * cosine_integral(map, x, y, normal);
    return Rgb(sum);
}

}  // namespace inlay
