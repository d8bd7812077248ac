#include "composite/session/measure_up.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace inlay {
namespace {

constexpr float same_direction = 0.985f;  // cos 10 degrees
constexpr float upright = 0.5f;           // cos 60 degrees
constexpr int stride = 4;                 // px between the normals that are looked at
constexpr std::size_t candidates = 500;

std::vector<glm::vec3> sampled_normals(const SurfaceMap& surface) {
    std::vector<glm::vec3> normals;
    for (int y = 0; y < surface.lens.height; y += stride)
        for (int x = 0; x < surface.lens.width; x += stride)
            if (surface.has_surface(x, y)) normals.push_back(surface.normal(x, y));
    return normals;
}

std::size_t support(const std::vector<glm::vec3>& normals, const glm::vec3& direction) {
    return std::size_t(std::count_if(normals.begin(), normals.end(), [&](const glm::vec3& n) {
        return glm::dot(n, direction) > same_direction;
    }));
}

/// The mean of the normals near `direction`, until it settles.
glm::dvec3 refined(const std::vector<glm::vec3>& normals, glm::dvec3 direction) {
    for (int i = 0; i < 10; ++i) {
        glm::dvec3 sum(0);
        for (const glm::vec3& n : normals)
            if (glm::dot(glm::dvec3(n), direction) > same_direction) sum += glm::dvec3(n);
        direction = glm::normalize(sum);
    }
    return direction;
}

}  // namespace

std::optional<glm::dvec3> measure_up(const SurfaceMap& surface) {
    const std::vector<glm::vec3> normals = sampled_normals(surface);
    const std::size_t step = std::max<std::size_t>(1, normals.size() / candidates);
    std::size_t best_support = 0;
    glm::vec3 best(0);
    for (std::size_t i = 0; i < normals.size(); i += step) {
        if (-normals[i].y < upright) continue;
        const std::size_t agreeing = support(normals, normals[i]);
        if (agreeing > best_support) {
            best_support = agreeing;
            best = normals[i];
        }
    }
    if (best_support == 0 || best_support * 20 < normals.size()) return std::nullopt;
    return surface.world_from_camera.rotation * refined(normals, best);
}

}  // namespace inlay
