#include "slam/track/se3.h"

#include <cmath>

namespace inlay {
namespace {

glm::dmat3 cross_matrix(const glm::dvec3& w) {
    return {glm::dvec3(0, w.z, -w.y), glm::dvec3(-w.z, 0, w.x), glm::dvec3(w.y, -w.x, 0)};
}

/// sin(a)/a, (1 - cos a)/a^2 and (a - sin a)/a^3, by series where the quotients lose digits.
struct Coefficients {
    double a, b, c;
};

Coefficients coefficients(double angle) {
    const double s = angle * angle;
    if (s < 1e-4) {
        return {1 - s / 6 * (1 - s / 20 * (1 - s / 42)), 0.5 - s / 24 * (1 - s / 30 * (1 - s / 56)),
                1.0 / 6 - s / 120 * (1 - s / 42 * (1 - s / 72))};
    }
    const double sine_half = std::sin(angle / 2);
    return {std::sin(angle) / angle, 2 * sine_half * sine_half / s,
            (angle - std::sin(angle)) / (s * angle)};
}

}  // namespace

Pose exponential(const Twist& twist) {
    const Coefficients k = coefficients(glm::length(twist.rotation));
    const glm::dmat3 w = cross_matrix(twist.rotation);
    const glm::dmat3 w2 = w * w;
    const glm::dmat3 rotation = glm::dmat3(1.0) + k.a * w + k.b * w2;
    const glm::dmat3 coupling = glm::dmat3(1.0) + k.b * w + k.c * w2;
    return {rotation, coupling * twist.translation};
}

Twist logarithm(const Pose& motion) {
    glm::dquat q = glm::normalize(glm::quat_cast(motion.rotation));
    if (q.w < 0) q = -q;
    const glm::dvec3 axis(q.x, q.y, q.z);
    const double sine = glm::length(axis);
    const double angle = 2 * std::atan2(sine, q.w);
    const glm::dvec3 rotation = sine > 1e-8 ? axis * (angle / sine) : 2.0 * axis;
    const Coefficients k = coefficients(angle);
    const glm::dmat3 w = cross_matrix(rotation);
    const glm::dmat3 coupling = glm::dmat3(1.0) + k.b * w + k.c * (w * w);
    return {rotation, glm::inverse(coupling) * motion.translation};
}

Pose orthonormalized(const Pose& pose) {
    return {glm::mat3_cast(glm::normalize(glm::quat_cast(pose.rotation))), pose.translation};
}

}  // namespace inlay
