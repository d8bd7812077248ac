// Clips rays in homogeneous image coordinates, where every limit is linear in the distance.
#include "render/trace/image_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inlay {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Interval {
    double from, to;
    bool empty() const { return !(from <= to); }
};

/// Keeps the t with value + t slope >= 0. Limits beyond 1e12 m count as never reached.
void clip(Interval& t, double value, double slope) {
    constexpr double out_of_reach = 1e12;
    if (std::abs(slope) * out_of_reach <= std::abs(value)) {
        if (value < 0) t.to = -infinity;
    } else if (slope > 0) {
        t.from = std::max(t.from, -value / slope);
    } else {
        t.to = std::min(t.to, -value / slope);
    }
}

struct LinePoint {
    glm::dvec2 image;
    double inverse_z, distance;
};

LinePoint point_at(const CameraRay& ray, const Lens& lens, double t) {
    const glm::dvec3 p = ray.origin + t * ray.direction;
    return {{lens.fx * (p.x / p.z) + lens.cx, lens.fy * (p.y / p.z) + lens.cy}, 1 / p.z, t};
}

}  // namespace

ClippedRay clip_to_image(const CameraRay& ray, const Lens& lens, const InverseDepthRange& depths) {
    const glm::dvec3 o = ray.origin, d = ray.direction;
    Interval t{ray.t_min, infinity};
    const auto keep_right_of = [&](double edge, double f, double c, int axis, double sign) {
        clip(t, sign * (f * o[axis] + (c - edge) * o.z), sign * (f * d[axis] + (c - edge) * d.z));
    };
    keep_right_of(-0.5, lens.fx, lens.cx, 0, 1);
    keep_right_of(lens.width - 0.5, lens.fx, lens.cx, 0, -1);
    keep_right_of(-0.5, lens.fy, lens.cy, 1, 1);
    keep_right_of(lens.height - 0.5, lens.fy, lens.cy, 1, -1);
    clip(t, o.z, d.z);
    if (t.empty()) return {std::nullopt, true};

    const bool leaves = t.to < infinity;
    if (depths.farthest > depths.nearest) return {std::nullopt, leaves};
    clip(t, o.z - 1 / double(depths.nearest), d.z);
    clip(t, 1 / double(depths.farthest) - o.z, -d.z);
    if (t.empty()) return {std::nullopt, leaves};

    const LinePoint a = point_at(ray, lens, t.from), b = point_at(ray, lens, t.to);
    return {ImageRay{a.image, b.image - a.image, a.inverse_z, b.inverse_z - a.inverse_z,
                     a.distance * a.inverse_z, b.distance * b.inverse_z - a.distance * a.inverse_z,
                     t.from == ray.t_min},
            leaves};
}

}  // namespace inlay
