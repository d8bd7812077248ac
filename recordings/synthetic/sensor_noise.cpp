#include "recordings/synthetic/sensor_noise.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace inlay {
namespace {

/// Which random number is for what.
enum Dimension : std::uint32_t { axial = 0, lateral = 2, edge = 4, grazing = 5 };

struct Sensor {
    const Image<float>& depth;
    const Lens& lens;
    const DepthNoiseSettings& settings;
};

/// Two independent normal numbers (Box and Muller 1958).
glm::vec2 normal_pair(const SampleKey& key, std::uint32_t dimension) {
    const float radius = std::sqrt(-2 * std::log(1 - uniform(key, dimension)));
    const float angle = 2 * std::numbers::pi_v<float> * uniform(key, dimension + 1);
    return radius * glm::vec2(std::cos(angle), std::sin(angle));
}

/// Depth at the nearest pixel inside the image.
float depth_at(const Sensor& sensor, int x, int y) {
    return sensor.depth(std::clamp(x, 0, sensor.depth.width - 1),
                        std::clamp(y, 0, sensor.depth.height - 1));
}

/// Whether a neighbour's depth differs by more than the threshold, or is missing.
bool at_depth_edge(const Sensor& sensor, int x, int y) {
    const float z = sensor.depth(x, y);
    for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
            if (std::abs(depth_at(sensor, x + dx, y + dy) - z) > sensor.settings.edge_step * z)
                return true;
    return false;
}

glm::vec3 point_at(const Sensor& sensor, int x, int y) {
    const int inside_x = std::clamp(x, 0, sensor.depth.width - 1);
    const int inside_y = std::clamp(y, 0, sensor.depth.height - 1);
    const glm::dvec3 ray = unproject(sensor.lens, glm::dvec2(inside_x, inside_y));
    return glm::vec3(ray) * sensor.depth(inside_x, inside_y);
}

/// Angle (rad) between the surface's normal, from central differences, and the ray to the camera.
float incidence(const Sensor& sensor, int x, int y) {
    const glm::vec3 across = point_at(sensor, x + 1, y) - point_at(sensor, x - 1, y);
    const glm::vec3 down = point_at(sensor, x, y + 1) - point_at(sensor, x, y - 1);
    const glm::vec3 normal = glm::cross(across, down);
    const glm::vec3 view = point_at(sensor, x, y);
    return std::atan2(glm::length(glm::cross(normal, view)), std::abs(glm::dot(normal, view)));
}

bool dropped(const Sensor& sensor, int x, int y, const SampleKey& key) {
    const DepthNoiseSettings& s = sensor.settings;
    if (at_depth_edge(sensor, x, y)) return uniform(key, Dimension::edge) < s.edge_dropout;
    const float share =
        (incidence(sensor, x, y) - s.grazing_start) / (s.grazing_end - s.grazing_start);
    return uniform(key, Dimension::grazing) < share;
}

/// Depth difference (m) of one disparity step at z: z = f b / d.
float disparity_step_depth(float z, const Lens& lens, const DepthNoiseSettings& s) {
    return s.disparity_step * z * z / (float(lens.fx) * s.baseline);
}

/// The Gaussian part of axial_sigma: what remains when the variance of rounding, step^2 / 12, is
/// taken off for both roundings. At least half, so that rounding errors stay spread out.
float gaussian_sigma(float z, const Lens& lens, const DepthNoiseSettings& s) {
    const float sigma = axial_sigma(z, s);
    const float step = disparity_step_depth(z, lens, s);
    const float rounding = (step * step + s.depth_unit * s.depth_unit) / 12;
    return std::sqrt(std::max(sigma * sigma - rounding, 0.25f * sigma * sigma));
}

float rounded_to(float value, float step) {
    return step > 0 ? step * std::round(value / step) : value;
}

float quantised(float z, const Lens& lens, const DepthNoiseSettings& s) {
    if (s.disparity_step > 0) {
        const float product = float(lens.fx) * s.baseline;
        z = product / std::max(rounded_to(product / z, s.disparity_step), s.disparity_step);
    }
    return rounded_to(z, s.depth_unit);
}

float measured(const Sensor& sensor, int x, int y, const SampleKey& key) {
    const DepthNoiseSettings& s = sensor.settings;
    if (!(sensor.depth(x, y) > 0) || dropped(sensor, x, y, key)) return 0;
    const glm::vec2 shift = s.lateral_sigma * normal_pair(key, Dimension::lateral);
    const float z = depth_at(sensor, x + int(std::lround(shift.x)), y + int(std::lround(shift.y)));
    if (!(z >= s.nearest && z <= s.farthest)) return 0;
    const float noisy =
        z + gaussian_sigma(z, sensor.lens, s) * normal_pair(key, Dimension::axial).x;
    return noisy > 0 ? quantised(noisy, sensor.lens, s) : 0;
}

}  // namespace

void validate(const DepthNoiseSettings& s) {
    const auto check = [](bool good, const char* what) {
        require(good, std::string("depth noise: ") + what, ExitCode::usage);
    };
    check(s.axial_floor >= 0 && s.axial_growth >= 0 && s.lateral_sigma >= 0,
          "axial_floor, axial_growth and lateral_sigma must be 0 or more");
    check(s.lateral_sigma <= 100, "lateral_sigma must be at most 100 px");
    check(s.baseline > 0 && s.disparity_step >= 0 && s.depth_unit >= 0,
          "baseline must be above 0, disparity_step and depth_unit 0 or more");
    check(s.edge_step > 0 && s.edge_dropout >= 0 && s.edge_dropout <= 1,
          "edge_step must be above 0 and edge_dropout in 0..1");
    check(s.grazing_start < s.grazing_end, "grazing_start must be below grazing_end");
    check(s.nearest >= 0 && s.nearest < s.farthest, "nearest must be below farthest");
}

float axial_sigma(float z, const DepthNoiseSettings& s) {
    const float beyond = z - s.axial_nearest;
    return s.axial_floor + s.axial_growth * beyond * beyond;
}

Image<float> simulate_sensor(const Image<float>& depth, const Lens& lens, const SampleKey& key,
                             const DepthNoiseSettings& settings) {
    validate(settings);
    require(depth.width == lens.width && depth.height == lens.height,
            "depth is " + std::to_string(depth.width) + " x " + std::to_string(depth.height) +
                " px, the lens " + std::to_string(lens.width) + " x " +
                std::to_string(lens.height) + " px");
    const Sensor sensor{depth, lens, settings};
    Image<float> result(depth.width, depth.height);
    parallel_rows(depth.height, [&](int y) {
        for (int x = 0; x < depth.width; ++x) {
            SampleKey pixel_key = key;
            pixel_key.pixel = std::uint32_t(depth.index(x, y));
            result(x, y) = measured(sensor, x, y, pixel_key);
        }
    });
    return result;
}

}  // namespace inlay
