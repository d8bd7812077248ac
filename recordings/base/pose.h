// Pose: rigid motions named target_from_source, and their algebra.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace inlay {

/// Takes points from a source frame into a target frame: x_target = rotation * x_source +
/// translation. The variable's name says which: world_from_camera, camera_from_world.
struct Pose {
    glm::dmat3 rotation{1.0};     // orthonormal, determinant +1
    glm::dvec3 translation{0.0};  // m
};

inline glm::dvec3 operator*(const Pose& b_from_a, const glm::dvec3& p_a) {
    return b_from_a.rotation * p_a + b_from_a.translation;
}

inline Pose operator*(const Pose& c_from_b, const Pose& b_from_a) {
    return {c_from_b.rotation * b_from_a.rotation,
            c_from_b.rotation * b_from_a.translation + c_from_b.translation};
}

inline Pose inverse(const Pose& b_from_a) {
    const glm::dmat3 a_from_b = glm::transpose(b_from_a.rotation);
    return {a_from_b, -(a_from_b * b_from_a.translation)};
}

/// The pose as a 4x4 matrix (glm: column-major in memory).
inline glm::dmat4 to_matrix(const Pose& b_from_a) {
    glm::dmat4 m(b_from_a.rotation);
    m[3] = glm::dvec4(b_from_a.translation, 1.0);
    return m;
}

inline Pose from_matrix(const glm::dmat4& m) { return {glm::dmat3(m), glm::dvec3(m[3])}; }

/// Angle (rad, 0..pi) between two orientations. From the chord, so that tiny angles keep their
/// digits.
inline double rotation_angle(const Pose& a, const Pose& b) {
    const glm::dmat3 d = glm::transpose(a.rotation) * b.rotation;
    const glm::dvec3 axis{d[1][2] - d[2][1], d[2][0] - d[0][2], d[0][1] - d[1][0]};
    const double twice_cosine = d[0][0] + d[1][1] + d[2][2] - 1.0;
    return std::atan2(glm::length(axis), twice_cosine);
}

/// Between `a` (t = 0) and `b` (t = 1): translation linearly, rotation along the shortest arc.
inline Pose interpolate(const Pose& a, const Pose& b, double t) {
    const glm::dquat q = glm::slerp(glm::quat_cast(a.rotation), glm::quat_cast(b.rotation), t);
    return {glm::mat3_cast(glm::normalize(q)), glm::mix(a.translation, b.translation, t)};
}

}  // namespace inlay
