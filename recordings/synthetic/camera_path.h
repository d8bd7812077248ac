// Camera paths: smooth functions of time, steady or held in a hand.
#pragma once

#include "recordings/base/pose.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace inlay {

/// world_from_camera at a time (s).
using CameraPath = std::function<Pose(double time)>;

/// The pose of a camera at `eye` that looks at `target` (m, world); image up is as close to `up`
/// (any length) as it can be. Throws Error (bad_data) when the view has no direction or runs along
/// `up`.
Pose look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// A camera that goes round `target` and looks at it.
struct Orbit {
    glm::dvec3 target{0};    // m, world
    glm::dvec3 start{0};     // m, world, where the camera is at time 0
    glm::dvec3 up{0, 1, 0};  // axis of the motion
    double angle = 0.6;      // rad, between the two ends
    double period = 10;      // s, there and back: it swings and comes to rest at both ends
};
CameraPath orbit_path(const Orbit& orbit);

/// Where the camera is at a time (s).
struct PathKey {
    double time = 0;
    Pose world_from_camera;
};

/// Passes through all keys with continuous velocity and stays at the first before it and at the
/// last after it (Catmull and Rom 1974, for times that are not evenly spaced). Throws Error
/// (bad_data) when there is no key or times do not increase.
CameraPath keyframe_path(std::vector<PathKey> keys);

/// How a hand shakes: a few sines for each of the six degrees of freedom.
struct ShakeSettings {
    double translation = 0.004;  // m, root mean square for each axis
    double rotation = 0.005;     // rad, root mean square for each axis
    double frequency = 0.7;      // Hz, of the slowest sine; the fastest is 4.3 times as fast
    std::uint32_t seed = 1;
};

/// `path` with shake in the camera's own frame.
CameraPath hand_held(CameraPath path, const ShakeSettings& settings);

}  // namespace inlay
