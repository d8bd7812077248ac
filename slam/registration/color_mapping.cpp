#include "slam/registration/color_mapping.h"

#include "slam/track/se3.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr double nearest_depth = 0.05;  // m in front of the color camera
constexpr double half_step = 1e-3;      // s, for the camera's velocity

/// Extrapolates by no more than one interval before the first pose and one after the last.
Pose camera_at(std::span<const TimedCamera> trajectory, double time) {
    const auto after =
        std::upper_bound(trajectory.begin() + 1, trajectory.end() - 1, time,
                         [](double t, const TimedCamera& camera) { return t < camera.time; });
    const TimedCamera &a = *(after - 1), &b = *after;
    const double share = (time - a.time) / (b.time - a.time);
    return interpolate(a.world_from_camera, b.world_from_camera, std::clamp(share, -1.0, 2.0));
}

/// How a lens's normalised position x/z, y/z changes the image position (px), distortion included:
/// the derivative of lens.h's project().
glm::dmat2 lens_slope(const Lens& lens, const glm::dvec2& n) {
    glm::dmat2 bend(1.0);
    if (distorted(lens)) {
        const double r2 = glm::dot(n, n);
        const double radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
        const double growth = 2 * (lens.k1 + r2 * (2 * lens.k2 + r2 * 3 * lens.k3));
        const double mixed = growth * n.x * n.y + 2 * lens.p1 * n.x + 2 * lens.p2 * n.y;
        bend[0] = {radial + growth * n.x * n.x + 2 * lens.p1 * n.y + 6 * lens.p2 * n.x, mixed};
        bend[1] = {mixed, radial + growth * n.y * n.y + 6 * lens.p1 * n.y + 2 * lens.p2 * n.x};
    }
    return glm::dmat2(glm::dvec2(lens.fx, lens.fy) * bend[0],
                      glm::dvec2(lens.fx, lens.fy) * bend[1]);
}

}  // namespace

MappingStep parameters_of(const ColorMapping& mapping) {
    const glm::dvec3 r = logarithm({mapping.color_from_depth.rotation, {}}).rotation;
    const glm::dvec3& t = mapping.color_from_depth.translation;
    return {r.x, r.y, r.z, t.x, t.y, t.z, mapping.delay, mapping.log_focal, mapping.rim};
}

ColorMapping moved(const ColorMapping& mapping, const MappingStep& step) {
    using Index = MappingParameter;
    ColorMapping result = mapping;
    Pose& pose = result.color_from_depth;
    pose.rotation = exponential({{step[0], step[1], step[2]}, {}}).rotation * pose.rotation;
    pose.translation += glm::dvec3(step[3], step[4], step[5]);
    pose = orthonormalized(pose);
    result.delay += step[Index::delay];
    result.log_focal += step[Index::log_focal];
    result.rim += step[Index::rim];
    return result;
}

Lens refined(const Lens& color_lens, const ColorMapping& mapping) {
    Lens lens = color_lens;
    lens.fx *= std::exp(mapping.log_focal);
    lens.fy *= std::exp(mapping.log_focal);
    return lens;
}

FrameMapping mapping_at(const ColorMapping& mapping, const Lens& color_lens,
                        std::span<const TimedCamera> trajectory, double time) {
    FrameMapping result;
    result.color_from_depth = mapping.color_from_depth;
    result.pivot = mapping.color_from_depth.translation;
    result.lens = refined(color_lens, mapping);
    result.rim = mapping.rim;
    if (trajectory.size() < 2) return result;
    const Pose world_from_depth = camera_at(trajectory, time);
    const auto after = [&](double delay) {
        const Pose motion = inverse(camera_at(trajectory, time + delay)) * world_from_depth;
        return mapping.color_from_depth * motion;
    };
    const Pose before = after(mapping.delay - half_step), then = after(mapping.delay + half_step);
    result.color_from_depth = after(mapping.delay);
    result.turn = (then.rotation - before.rotation) / (2 * half_step);
    result.drift = (then.translation - before.translation) / (2 * half_step);
    return result;
}

SeenRim see(const FrameMapping& mapping, const RimPoint& point) {
    SeenRim seen;
    const Lens& lens = mapping.lens;
    const glm::dvec3 p = mapping.color_from_depth * (point.position + mapping.rim * point.outward);
    if (!(p.z > nearest_depth)) return seen;
    const glm::dvec2 n(p.x / p.z, p.y / p.z);
    seen.p_color = p;
    seen.position = project(lens, p);
    const glm::dmat2 slope = lens_slope(lens, n);
    seen.slope = glm::dmat3x2(slope[0] / p.z, slope[1] / p.z, -(slope * n) / p.z);
    seen.outward = seen.slope * (mapping.color_from_depth.rotation * point.outward);
    const double length = glm::length(seen.outward);
    seen.ahead = length > 0;
    if (seen.ahead) seen.normal = seen.outward / length;
    return seen;
}

MappingStep derivative(const FrameMapping& mapping, const RimPoint& point, const SeenRim& seen,
                       const glm::dvec2& direction) {
    const glm::dvec3 pull = direction * seen.slope;  // per m of p_color
    const glm::dvec3 turning = glm::cross(seen.p_color - mapping.pivot, pull);
    const glm::dvec3 velocity =
        mapping.turn * (point.position + mapping.rim * point.outward) + mapping.drift;
    const glm::dvec2 from_center = seen.position - glm::dvec2(mapping.lens.cx, mapping.lens.cy);
    return {turning.x,
            turning.y,
            turning.z,
            pull.x,
            pull.y,
            pull.z,
            glm::dot(pull, velocity),
            glm::dot(direction, from_center),
            glm::dot(direction, seen.outward)};
}

}  // namespace inlay
