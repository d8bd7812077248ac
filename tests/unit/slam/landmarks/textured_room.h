// A room with a random pattern on its walls, in color and exact depth from everywhere.
#pragma once

#include "recordings/base/rgbd_frame.h"
#include "tests/unit/slam/analytic_room.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace inlay::test {

/// Points of one wall of the room: those with dot(normal, p) = offset.
struct PatternedWall {
    glm::dvec3 normal;
    double offset;            // m
    glm::dvec3 across, down;  // unit, along the wall
};

/// A wall ahead that is turned a little, a table below, and a wall to the left.
inline std::array<PatternedWall, 3> patterned_walls() {
    return {PatternedWall{{0.28, 0, -0.96}, -2.1, {0.96, 0, 0.28}, {0, 1, 0}},
            PatternedWall{{0, -1, 0}, -0.6, {1, 0, 0}, {0, 0, 1}},
            PatternedWall{{1, 0, 0}, -1.1, {0, 0, 1}, {0, 1, 0}}};
}

/// Squares of 1, 3 and 9 cm in random greys, laid over each other.
inline double pattern(double x, double y, std::uint32_t seed) {
    double grey = 0;
    for (std::uint32_t layer = 0; layer < 3; ++layer) {
        const double size = 0.01 * std::pow(3.0, layer);  // m
        const auto square = [&](double v) {
            return std::uint32_t(int(std::floor(v / size)) + 9999);
        };
        grey += double(uniform({seed, layer, square(x), square(y)}, 0)) / 3;
    }
    return grey;
}

/// Depth (m) and grey (0..1) along the ray with direction.z = 1 in the camera's frame.
inline std::pair<double, double> sample_room(const Pose& world_from_camera, const glm::dvec3& ray,
                                             std::uint32_t seed) {
    const glm::dvec3 eye = world_from_camera.translation;
    const glm::dvec3 direction = world_from_camera.rotation * ray;
    std::pair<double, double> nearest{std::numeric_limits<double>::max(), 0};
    std::uint32_t number = seed;
    for (const PatternedWall& wall : patterned_walls()) {
        number += 100;
        const double along = glm::dot(wall.normal, direction);
        const double t = (wall.offset - glm::dot(wall.normal, eye)) / along;
        if (along >= 0 || t > nearest.first) continue;
        const glm::dvec3 p = eye + t * direction;
        nearest = {t, pattern(glm::dot(p, wall.across), glm::dot(p, wall.down), number)};
    }
    return nearest;
}

/// The room from a pose, 3 x 3 rays a pixel for color; `seed` chooses the pattern.
inline RgbdFrame patterned_frame(const Lens& lens, const Pose& world_from_camera,
                                 std::uint32_t seed) {
    RgbdFrame frame;
    frame.lens = lens;
    frame.color = Image<EncodedRgb>(lens.width, lens.height);
    frame.depth = Image<float>(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            double grey = 0;
            for (int i = 0; i < 9; ++i) {
                const glm::dvec2 offset((i % 3 - 1) / 3.0, (i / 3 - 1) / 3.0);
                const glm::dvec3 ray = unproject(lens, glm::dvec2(x, y) + offset);
                grey += sample_room(world_from_camera, ray, seed).second / 9;
            }
            const auto byte = std::uint8_t(255 * grey);
            frame.color(x, y) = {byte, byte, byte};
            frame.depth(x, y) =
                float(sample_room(world_from_camera, unproject(lens, {x, y}), seed).first);
        }
    }
    return frame;
}

}  // namespace inlay::test
