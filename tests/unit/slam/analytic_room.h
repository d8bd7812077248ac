// A corner of a room with two balls in it, whose depth is known exactly from everywhere.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "recordings/base/random.h"
#include "recordings/base/rgbd_frame.h"
#include "slam/mapping/reconstruct_recording.h"

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace inlay::test {

struct Ball {
    glm::dvec3 centre;
    double radius;
};

/// Points p with dot(normal, p) = offset; the room is on the side the normal points to.
struct Wall {
    glm::dvec3 normal;
    double offset;
};

const std::array<Wall, 3> walls{Wall{{0, 0, -1}, -2.0}, {{0, -1, 0}, -0.8}, {{1, 0, 0}, -1.2}};
const std::array<Ball, 3> balls{
    Ball{{-0.3, 0.4, 1.5}, 0.4}, {{0.6, 0.55, 1.3}, 0.25}, {{0.5, -0.4, 1.8}, 0.3}};

/// Distance along a ray (any length of direction) in its own units; infinite where it meets
/// nothing.
inline double hit(const glm::dvec3& eye, const glm::dvec3& direction) {
    double nearest = std::numeric_limits<double>::max();
    for (const Wall& wall : walls) {
        const double along = glm::dot(wall.normal, direction);
        if (along >= 0) continue;
        nearest = std::min(nearest, (wall.offset - glm::dot(wall.normal, eye)) / along);
    }
    for (const Ball& ball : balls) {
        const glm::dvec3 from = eye - ball.centre;
        const double a = glm::dot(direction, direction), b = glm::dot(from, direction);
        const double d = b * b - a * (glm::dot(from, from) - ball.radius * ball.radius);
        if (d > 0 && -b - std::sqrt(d) > 0) nearest = std::min(nearest, (-b - std::sqrt(d)) / a);
    }
    return nearest;
}

/// Distance (m) of a point from the nearest surface.
inline double distance_from_surface(const glm::dvec3& p) {
    double nearest = std::numeric_limits<double>::max();
    for (const Wall& wall : walls) {
        nearest = std::min(nearest, std::abs(glm::dot(wall.normal, p) - wall.offset));
    }
    for (const Ball& ball : balls) {
        nearest = std::min(nearest, std::abs(glm::length(p - ball.centre) - ball.radius));
    }
    return nearest;
}

/// A small lens: 160 x 120 px, 60 degrees wide.
inline Lens small_lens() { return {160, 120, 140, 140, 79.5, 59.5}; }

inline Image<float> room_depth(const Lens& lens, const Pose& world_from_camera) {
    Image<float> depth(lens.width, lens.height);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::dvec3 ray = world_from_camera.rotation * unproject(lens, {x, y});
            depth(x, y) = float(hit(world_from_camera.translation, ray));
        }
    }
    return depth;
}

/// A frame of the room; `noise` is a factor on the depth noise of a structured-light camera.
inline RgbdFrame room_frame(int index, const Pose& world_from_camera, float noise = 0,
                            const Lens& lens = small_lens()) {
    RgbdFrame frame{index, index / 30.0, lens, {}, room_depth(lens, world_from_camera), {}};
    frame.color = Image<EncodedRgb>(lens.width, lens.height, EncodedRgb{200, 100, 50});
    for (std::size_t i = 0; i < frame.depth.pixels.size() && noise > 0; ++i) {
        const SampleKey key{7, std::uint32_t(index), std::uint32_t(i), 0};
        float sum = -2;  // four uniform numbers: variance 1/3, near enough to a Gaussian
        for (std::uint32_t d = 0; d < 4; ++d)
            sum += uniform(key, d);
        float& z = frame.depth.pixels[i];
        z += noise * 1.732f * sum * (0.0012f + 0.0019f * (z - 0.4f) * (z - 0.4f));
    }
    return frame;
}

/// Frames 0 to `count` - 1, 30 a second.
inline FrameSource frames_from(int count, std::function<RgbdFrame(int)> load) {
    FrameSource source{{}, {}, std::move(load)};
    for (int i = 0; i < count; ++i) {
        source.numbers.push_back(i);
        source.times.push_back(i / 30.0);
    }
    return source;
}

/// A pose turned by small angles (rad) about x, y, z of the camera, and moved (m).
inline Pose posed(const glm::dvec3& angles, const glm::dvec3& translation) {
    const double angle = glm::length(angles);
    const glm::dquat q = angle > 0 ? glm::angleAxis(angle, angles / angle) : glm::dquat(1, 0, 0, 0);
    return {glm::mat3_cast(q), translation};
}

}  // namespace inlay::test
