#include "slam/depth/steep_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace inlay {
namespace {

constexpr int reach = 2;         // px, half-width of the window
constexpr int least_pixels = 6;  // that a plane is fitted to
constexpr double least_width =
    0.4;  // px^2, variance of three columns of pixels is 0.67, of two 0.25
constexpr float lateral_noise = 2;  // px: two standard deviations of the place that is measured

/// Sums of (dx, dy) and of the inverse z over the pixels that count.
struct Moments {
    int count = 0;
    glm::dvec2 sum{0}, with_q{0};
    glm::dmat2 square{0};
    double q = 0;

    void add(const glm::dvec2& p, double inverse_z) {
        ++count;
        sum += p;
        square += glm::outerProduct(p, p);
        with_q += p * inverse_z;
        q += inverse_z;
    }
};

Moments gather(const Image<float>& depth, const glm::ivec2& at, const DepthSettings& settings,
               const Image<unsigned char>* counted) {
    const float z = depth(at.x, at.y), step = depth_step(z, settings);
    Moments moments;
    for (int dy = -reach; dy <= reach; ++dy) {
        for (int dx = -reach; dx <= reach; ++dx) {
            const int x = at.x + dx, y = at.y + dy;
            if (!depth.contains(x, y) || !(depth(x, y) > 0)) continue;
            if (counted != nullptr && (*counted)(x, y) == 0) continue;
            const auto distance = float(std::max(std::abs(dx), std::abs(dy)));
            if (!(std::abs(depth(x, y) - z) <= step + distance * settings.steepest * z)) continue;
            moments.add({dx, dy}, 1.0 / double(depth(x, y)));
        }
    }
    return moments;
}

double smaller_eigenvalue(const glm::dmat2& m) {
    const double half_trace = (m[0][0] + m[1][1]) / 2;
    return half_trace - std::sqrt(std::max(0.0, half_trace * half_trace - glm::determinant(m)));
}

}  // namespace

double ImagePlane::depth_at(int dx, int dy) const {
    return 1 / (inverse_z + glm::dot(per_pixel, glm::dvec2(dx, dy)));
}

std::optional<ImagePlane> steep_plane(const Image<float>& depth, const glm::ivec2& at,
                                      const DepthSettings& settings,
                                      const Image<unsigned char>* counted) {
    const Moments m = gather(depth, at, settings, counted);
    if (m.count < least_pixels) return std::nullopt;
    const double n = m.count;
    const glm::dvec2 mean = m.sum / n;
    const glm::dmat2 scatter = m.square / n - glm::outerProduct(mean, mean);
    if (!(smaller_eigenvalue(scatter) >= least_width)) return std::nullopt;
    ImagePlane plane;
    plane.centre = mean;
    plane.per_pixel = glm::inverse(scatter) * (m.with_q / n - mean * (m.q / n));
    plane.inverse_z = m.q / n - glm::dot(plane.per_pixel, mean);
    const double z = double(depth(at.x, at.y));
    const double recedes = glm::length(plane.per_pixel) * z;  // share of depth per pixel
    if (!(recedes <= double(settings.steepest) && plane.inverse_z > 0)) return std::nullopt;
    const double missed = std::abs(1 / plane.inverse_z - z);
    const double tolerated =
        double(depth_step(float(z), settings)) + double(lateral_noise) * recedes * z;
    if (!(missed <= tolerated)) return std::nullopt;
    return plane;
}

}  // namespace inlay
