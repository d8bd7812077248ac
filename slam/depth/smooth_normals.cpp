#include "slam/depth/smooth_normals.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

glm::vec3 window_sum(const SurfaceMap& surface, int x, int y, const NormalSmoothing& s) {
    const float depth = surface.position(x, y).z;
    const glm::vec3 own = surface.normal(x, y);
    glm::vec3 sum(0);
    for (int j = std::max(0, y - s.radius); j <= std::min(surface.lens.height - 1, y + s.radius);
         ++j) {
        for (int i = std::max(0, x - s.radius); i <= std::min(surface.lens.width - 1, x + s.radius);
             ++i) {
            if (std::abs(surface.position(i, j).z - depth) > s.depth_step * depth) continue;
            const glm::vec3& n = surface.normal(i, j);
            if (glm::dot(n, own) > s.crease_cosine) sum += n;
        }
    }
    return sum;
}

}  // namespace

Image<glm::vec3> smooth_normals(const SurfaceMap& surface, const NormalSmoothing& settings) {
    Image<glm::vec3> result = surface.normal;
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x) {
            const float missing = 1 - std::clamp(surface.confidence(x, y), 0.0f, 1.0f);
            if (!surface.has_surface(x, y) || missing == 0) continue;
            const glm::vec3 sum = window_sum(surface, x, y, settings);
            const float length = glm::length(sum);
            if (!(length > 0)) continue;
            const glm::vec3 mixed = glm::mix(surface.normal(x, y), sum / length, missing);
            if (glm::dot(mixed, mixed) > 0) result(x, y) = glm::normalize(mixed);
        }
    });
    return result;
}

}  // namespace inlay
