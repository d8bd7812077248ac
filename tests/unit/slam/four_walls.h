// A room with four walls, knobs on them, and a camera that goes around along the walls.
#pragma once

#include "recordings/base/parallel.h"
#include "tests/unit/slam/analytic_room.h"

#include <algorithm>
#include <numbers>
#include <vector>

namespace inlay::test {

constexpr double half_room = 2.5;  // m

/// Balls half sunk into the walls, no two alike, so that a view tells where it is.
inline std::vector<Ball> knobs() {
    std::vector<Ball> result;
    for (std::uint32_t i = 0; i < 160; ++i) {
        const SampleKey key{11, 0, i, 0};
        const double along = (2 * double(uniform(key, 0)) - 1) * half_room;
        const double height = (2 * double(uniform(key, 1)) - 1) * 1.0;
        const double radius = 0.1 + 0.2 * double(uniform(key, 2));
        const double wall = i % 2 == 0 ? half_room : -half_room;
        result.push_back(
            {i % 4 < 2 ? glm::dvec3(along, height, wall) : glm::dvec3(wall, height, along),
             radius});
    }
    return result;
}

/// Where the camera is after `share` of its way around: 1.2 m from the middle, looking outwards.
inline Pose around_the_room(double share) {
    const double angle = 2 * std::numbers::pi * share;
    return posed({0, angle, 0},
                 {1.2 * std::sin(angle), 0.05 * std::sin(3 * angle), 1.2 * std::cos(angle)});
}

inline double hit_room(const glm::dvec3& eye, const glm::dvec3& ray,
                       const std::vector<Ball>& in_it) {
    double nearest = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis) {
        const double wall = axis == 1 ? 1.3 : half_room;
        if (ray[axis] == 0) continue;
        nearest = std::min(nearest, ((ray[axis] > 0 ? wall : -wall) - eye[axis]) / ray[axis]);
    }
    for (const Ball& ball : in_it) {
        const glm::dvec3 from = eye - ball.centre;
        const double a = glm::dot(ray, ray), b = glm::dot(from, ray);
        const double d = b * b - a * (glm::dot(from, from) - ball.radius * ball.radius);
        if (d > 0 && -b - std::sqrt(d) > 0) nearest = std::min(nearest, (-b - std::sqrt(d)) / a);
    }
    return nearest;
}

/// Squares of paint, 8 cm wide and no two rows alike: the brightness at a point of the walls.
inline std::uint8_t paint(const glm::dvec3& p) {
    const auto cell = [](double along) {
        return std::uint32_t(std::int32_t(std::floor(along / 0.08)));
    };
    const SampleKey key{cell(p.x) * 73u + cell(p.y), cell(p.z), 5, 3};
    return std::uint8_t(30 + 200 * uniform(key, 0));
}

/// A frame from there; `noise` is a factor on the depth noise of a structured-light camera, `bend`
/// the share by which depth is wrong at the image's left and right edges.
inline RgbdFrame wall_frame(int index, const Pose& world_from_camera, float noise, double bend,
                            const Lens& lens = small_lens(), bool painted = false) {
    static const std::vector<Ball> on_walls = knobs();
    RgbdFrame frame{index, index / 30.0, lens, {}, Image<float>(lens.width, lens.height), {}};
    if (painted) frame.color = Image<EncodedRgb>(lens.width, lens.height);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::dvec3 ray = world_from_camera.rotation * unproject(lens, {x, y});
            const double z = hit_room(world_from_camera.translation, ray, on_walls);
            if (painted) {
                const std::uint8_t grey = paint(world_from_camera.translation + 1.001 * z * ray);
                frame.color(x, y) = {grey, grey, grey};
            }
            const double side = 2.0 * x / lens.width - 1;
            const SampleKey key{7, std::uint32_t(index), std::uint32_t(y * lens.width + x), 0};
            double sum = -2;  // four uniform numbers: variance 1/3, near enough to a Gaussian
            for (std::uint32_t d = 0; d < 4; ++d)
                sum += double(uniform(key, d));
            const double sigma = 0.0012 + 0.0019 * (z - 0.4) * (z - 0.4);
            frame.depth(x, y) = float(z * (1 + bend * side * side) + noise * 1.732 * sum * sigma);
        }
    });
    return frame;
}

}  // namespace inlay::test
