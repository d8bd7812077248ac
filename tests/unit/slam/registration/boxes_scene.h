// Boxes of flat colors before a wall, seen by a depth camera and a color camera on one moving rig.
#pragma once

#include "slam/registration/register_color.h"
#include "tests/unit/slam/analytic_room.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace inlay::test {

struct Box {
    Pose box_from_world;
    glm::dvec3 half_size;  // m
    EncodedRgb color;
};

inline EncodedRgb some_color(std::uint32_t number) {
    const std::uint32_t bits = hash(number, 77);
    return {std::uint8_t(bits), std::uint8_t(bits >> 8), std::uint8_t(bits >> 16)};
}

constexpr double wall_z = 3.6;  // m

/// A grid of 5 x 4 boxes, turned at random, 1.1 to 2.9 m away from the origin.
inline std::vector<Box> boxes() {
    std::vector<Box> result;
    for (int i = 0; i < 20; ++i) {
        const SampleKey key{3, 0, std::uint32_t(i), 0};
        const auto random = [&](std::uint32_t d) { return double(uniform(key, d)); };
        const double z = 1.1 + 1.8 * random(0);
        const glm::dvec3 center(z * 0.27 * (i % 5 - 2), z * 0.25 * (i / 5 - 1.5), z);
        const glm::dvec3 angles(random(1) - 0.5, random(2) - 0.5, 3 * random(3));
        const double size = 0.075 * z;
        result.push_back({inverse(posed(angles, center)),
                          size * glm::dvec3(0.7 + 0.6 * random(4), 0.7 + 0.6 * random(5), 0.5),
                          some_color(std::uint32_t(i))});
    }
    return result;
}

/// Where a ray enters a box, in lengths of its direction, and through which of its three pairs of
/// faces; infinite where it misses. Kay and Kajiya 1986.
inline std::pair<double, int> entry(const Box& box, const glm::dvec3& eye,
                                    const glm::dvec3& direction) {
    const glm::dvec3 o = box.box_from_world * eye, d = box.box_from_world.rotation * direction;
    double in = 0, out = std::numeric_limits<double>::max();
    int face = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (-box.half_size[axis] - o[axis]) / d[axis];
        const double b = (box.half_size[axis] - o[axis]) / d[axis];
        if (std::min(a, b) > in) face = axis;
        in = std::max(in, std::min(a, b));
        out = std::min(out, std::max(a, b));
    }
    return {in < out ? in : std::numeric_limits<double>::max(), face};
}

struct SeenPixel {
    double z = 0;  // m
    EncodedRgb color;
};

inline SeenPixel look(const std::vector<Box>& scene, const Lens& lens,
                      const Pose& world_from_camera, const glm::dvec2& pixel) {
    const glm::dvec3 eye = world_from_camera.translation;
    const glm::dvec3 ray = world_from_camera.rotation * unproject(lens, pixel);
    SeenPixel seen{(wall_z - eye.z) / ray.z, {225, 220, 210}};
    for (const Box& box : scene) {
        const auto [z, face] = entry(box, eye, ray);
        if (z >= seen.z) continue;
        const auto shaded = [face = face](std::uint8_t c) {
            return std::uint8_t(c * (4 - face) / 5);
        };
        seen = {z, {shaded(box.color.r), shaded(box.color.g), shaded(box.color.b)}};
    }
    return seen;
}

/// Two cameras in one housing.
struct Rig {
    Lens depth_lens, color_lens;
    Pose color_from_depth;
    double delay = 0;  // s, of the color image
};

/// The depth camera's pose: a slow swing, up to 0.6 rad/s and 0.3 m/s.
inline Pose rig_at(double time) {
    return posed({0.12 * std::sin(3.1 * time), 0.16 * std::sin(3.7 * time + 1),
                  0.1 * std::sin(2.3 * time + 2)},
                 {0.1 * std::sin(2.9 * time), 0.08 * std::sin(3.3 * time), 0.1 * std::sin(time)});
}

inline RegistrationFrame rig_frame(const std::vector<Box>& scene, const Rig& rig, double time) {
    RegistrationFrame frame{{rig.depth_lens.width, rig.depth_lens.height},
                            {rig.color_lens.width, rig.color_lens.height},
                            time};
    const Pose world_from_depth = rig_at(time);
    const Pose world_from_color = rig_at(time + rig.delay) * inverse(rig.color_from_depth);
    for (int y = 0; y < frame.depth.height; ++y) {
        for (int x = 0; x < frame.depth.width; ++x)
            frame.depth(x, y) = float(look(scene, rig.depth_lens, world_from_depth, {x, y}).z);
    }
    for (int y = 0; y < frame.color.height; ++y) {
        for (int x = 0; x < frame.color.width; ++x)
            frame.color(x, y) = look(scene, rig.color_lens, world_from_color, {x, y}).color;
    }
    return frame;
}

/// Frames a quarter of a second apart.
inline std::vector<RegistrationFrame> rig_frames(const Rig& rig, int count) {
    const std::vector<Box> scene = boxes();
    std::vector<RegistrationFrame> frames;
    for (int i = 0; i < count; ++i)
        frames.push_back(rig_frame(scene, rig, 0.25 * i));
    return frames;
}

/// The depth camera's poses 30 times a second, from before the first to after the last frame.
inline std::vector<TimedCamera> rig_trajectory(int frames) {
    std::vector<TimedCamera> trajectory;
    for (double time = -0.2; time < 0.25 * frames + 0.2; time += 1 / 30.0)
        trajectory.push_back({time, rig_at(time)});
    return trajectory;
}

}  // namespace inlay::test
