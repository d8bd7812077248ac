// Screen-space curvature of a receiver, per pixel.
#include "recordings/base/parallel.h"
#include "render/filter/bandlimits.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace inlay {
namespace {

constexpr float no_pair = std::numeric_limits<float>::max();
constexpr float steepest_chord = 0.5f;  // sine of the angle to the mean tangent plane
constexpr float depth_noise = 2.0f;     // footprints

bool across_depth_edge(const glm::vec3& step, const glm::vec3& normals, float footprint) {
    const float out_of_plane = std::abs(glm::dot(normals, step));
    const float allowed = std::max(steepest_chord * glm::length(step), depth_noise * footprint);
    return out_of_plane > allowed * glm::length(normals);
}

/// Curvature between two pixels, or no_pair.
float between(const Receiver& r, std::size_t a, std::size_t b, float footprint) {
    if (r.object.pixels[a] == 0 || r.object.pixels[a] != r.object.pixels[b]) return no_pair;
    const glm::vec3 &p = r.position.pixels[a], &q = r.position.pixels[b];
    const glm::vec3 &n = r.normal.pixels[a], &m = r.normal.pixels[b];
    if (across_depth_edge(q - p, n + m, footprint)) return no_pair;
    return float(pair_curvature(p, n, q, m, footprint));
}

/// Curvature between each pixel and the one at the offset (1, 0) or (0, 1).
Image<float> pairs(const Receiver& r, const Image<float>& footprint, glm::ivec2 offset) {
    Image<float> result(footprint.width, footprint.height, no_pair);
    parallel_rows(footprint.height - offset.y, [&](int y) {
        for (int x = 0; x + offset.x < footprint.width; ++x) {
            const std::size_t a = footprint.index(x, y);
            const std::size_t b = footprint.index(x + offset.x, y + offset.y);
            result.pixels[a] = between(r, a, b, footprint.pixels[a]);
        }
    });
    return result;
}

/// The median of the pairs around a pixel that lie on its own object; 0 without any.
float median_around(const Image<float>& pair, const Image<std::uint32_t>& object, int x, int y) {
    std::array<float, 9> values{};
    int count = 0;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, pair.height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, pair.width - 1); ++u) {
            const float value = pair(u, v);
            if (value == no_pair || object(u, v) != object(x, y)) continue;
            int place = count++;
            for (; place > 0 && values[std::size_t(place - 1)] > value; --place)
                values[std::size_t(place)] = values[std::size_t(place - 1)];
            values[std::size_t(place)] = value;
        }
    }
    if (count == 0) return 0;
    return values[std::size_t(count / 2)];
}

Image<float> medians(const Image<float>& pair, const Image<std::uint32_t>& object) {
    Image<float> result(pair.width, pair.height, 0.0f);
    parallel_rows(pair.height, [&](int y) {
        for (int x = 0; x < pair.width; ++x) {
            if (object(x, y) != 0) result(x, y) = median_around(pair, object, x, y);
        }
    });
    return result;
}

}  // namespace

ScreenCurvature screen_curvature(const Receiver& receiver, const Image<float>& footprint) {
    return {medians(pairs(receiver, footprint, {1, 0}), receiver.object),
            medians(pairs(receiver, footprint, {0, 1}), receiver.object)};
}

Image<float> pixel_footprint(const Receiver& receiver, const Lens& lens,
                             const Pose& world_from_camera) {
    const glm::dvec3 forward = world_from_camera.rotation[2];
    const double focal = std::sqrt(std::abs(lens.fx * lens.fy));
    Image<float> result(receiver.object.width, receiver.object.height, 0.0f);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x) {
            if (receiver.object(x, y) == 0) continue;
            const glm::dvec3 ray =
                glm::dvec3(receiver.position(x, y)) - world_from_camera.translation;
            result(x, y) = float(std::abs(glm::dot(forward, ray)) / focal);
        }
    });
    return result;
}

}  // namespace inlay
