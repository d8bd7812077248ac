#include "recordings/synthetic/camera_path.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace inlay {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

/// Translation and rotation as seven numbers that may be blended and normalised.
struct Coordinates {
    glm::dvec3 translation{0};
    glm::dvec4 rotation{0};  // quaternion x, y, z, w
};

struct TimedCoordinates {
    double time = 0;
    Coordinates value;
};

Coordinates operator+(const Coordinates& a, const Coordinates& b) {
    return {a.translation + b.translation, a.rotation + b.rotation};
}

Coordinates operator-(const Coordinates& a, const Coordinates& b) {
    return {a.translation - b.translation, a.rotation - b.rotation};
}

Coordinates operator*(double s, const Coordinates& a) {
    return {s * a.translation, s * a.rotation};
}

Pose to_pose(const Coordinates& c) {
    const glm::dvec4 q = glm::normalize(c.rotation);
    return {glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z)), c.translation};
}

/// Quaternions of one orientation come in pairs; each is taken on the side of the one before.
std::vector<TimedCoordinates> coordinates_of(const std::vector<PathKey>& keys) {
    std::vector<TimedCoordinates> result;
    for (const PathKey& key : keys) {
        const glm::dquat q = glm::quat_cast(key.world_from_camera.rotation);
        glm::dvec4 rotation(q.x, q.y, q.z, q.w);
        if (!result.empty() && glm::dot(rotation, result.back().value.rotation) < 0)
            rotation = -rotation;
        result.push_back({key.time, {key.world_from_camera.translation, rotation}});
    }
    return result;
}

/// Change per second at key i: across its neighbours, 0 at both ends.
Coordinates velocity(const std::vector<TimedCoordinates>& keys, std::size_t i) {
    if (i == 0 || i + 1 == keys.size()) return {};
    const TimedCoordinates& before = keys[i - 1];
    const TimedCoordinates& after = keys[i + 1];
    return 1 / (after.time - before.time) * (after.value - before.value);
}

/// Cubic Hermite interpolation between the keys i and i + 1.
Coordinates between(const std::vector<TimedCoordinates>& keys, std::size_t i, double time) {
    const TimedCoordinates& a = keys[i];
    const TimedCoordinates& b = keys[i + 1];
    const double span = b.time - a.time;
    const double t = (time - a.time) / span;
    const double s = 1 - t;
    return s * s * (1 + 2 * t) * a.value + t * t * (1 + 2 * s) * b.value +
           s * s * t * span * velocity(keys, i) - t * t * s * span * velocity(keys, i + 1);
}

/// Rotation by |v| rad about v.
glm::dmat3 rotation_about(const glm::dvec3& v) {
    const double angle = glm::length(v);
    if (angle == 0) return glm::dmat3(1.0);
    return glm::mat3_cast(glm::angleAxis(angle, v / angle));
}

/// A sum of sines with root mean square 1. No ratio of the frequencies is a simple fraction, so
/// that the motion does not repeat within minutes.
double sway(double time, double frequency, const SampleKey& key) {
    constexpr std::array<double, 4> ratios{1.0, 1.618, 2.665, 4.3};
    constexpr std::array<double, 4> amplitudes{1.0, 0.7, 0.45, 0.25};
    double sum = 0;
    double power = 0;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        const double phase = two_pi * double(uniform(key, std::uint32_t(i)));
        sum += amplitudes[i] * std::sin(two_pi * frequency * ratios[i] * time + phase);
        power += amplitudes[i] * amplitudes[i] / 2;
    }
    return sum / std::sqrt(power);
}

glm::dvec3 sway_of_axes(double time, const ShakeSettings& s, std::uint32_t first_axis) {
    glm::dvec3 result{0};
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        result[int(axis)] = sway(time, s.frequency, {.seed = s.seed, .pixel = first_axis + axis});
    return result;
}

}  // namespace

Pose look_at(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up) {
    const glm::dvec3 view = target - eye;
    const glm::dvec3 side = glm::cross(view, up);
    // 1e-9: below it rounding alone decides where the image's x axis points
    require(glm::length(side) > 1e-9 * glm::length(view) * glm::length(up),
            "a camera that looks along the up direction has no upright picture: move its eye or "
            "its target sideways");
    const glm::dvec3 z = glm::normalize(view);
    const glm::dvec3 x = glm::normalize(side);
    return {glm::dmat3(x, glm::cross(z, x), z), eye};
}

CameraPath orbit_path(const Orbit& orbit) {
    require(orbit.period > 0, "an orbit's period must be above 0 s", ExitCode::usage);
    look_at(orbit.start, orbit.target, orbit.up);  // throws where the orbit is none
    return [orbit](double time) {
        const double swing = 0.5 - 0.5 * std::cos(two_pi * time / orbit.period);
        const glm::dmat3 turn = rotation_about(orbit.angle * swing * glm::normalize(orbit.up));
        return look_at(orbit.target + turn * (orbit.start - orbit.target), orbit.target, orbit.up);
    };
}

CameraPath keyframe_path(std::vector<PathKey> keys) {
    require(!keys.empty(), "a camera path needs at least one pose");
    for (std::size_t i = 1; i < keys.size(); ++i)
        require(keys[i].time > keys[i - 1].time,
                "camera path: the time of pose " + std::to_string(i) + " is " +
                    std::to_string(keys[i].time) + " s, expected more than the " +
                    std::to_string(keys[i - 1].time) + " s of the one before");
    return [keys = coordinates_of(keys)](double time) {
        if (time <= keys.front().time) return to_pose(keys.front().value);
        if (time >= keys.back().time) return to_pose(keys.back().value);
        const auto after =
            std::upper_bound(keys.begin(), keys.end(), time,
                             [](double t, const TimedCoordinates& key) { return t < key.time; });
        return to_pose(between(keys, std::size_t(after - keys.begin()) - 1, time));
    };
}

CameraPath hand_held(CameraPath path, const ShakeSettings& settings) {
    require(settings.translation >= 0 && settings.rotation >= 0 && settings.frequency > 0,
            "shake needs translation and rotation of 0 or more and a frequency above 0",
            ExitCode::usage);
    return [path = std::move(path), settings](double time) {
        const Pose steady_from_shaken{
            rotation_about(settings.rotation * sway_of_axes(time, settings, 0)),
            settings.translation * sway_of_axes(time, settings, 3)};
        return path(time) * steady_from_shaken;
    };
}

}  // namespace inlay
