#include "recordings/base/lens.h"

#include <cmath>

namespace inlay {
namespace {

glm::dvec2 distort(const Lens& lens, const glm::dvec2& n) {
    const double r2 = glm::dot(n, n);
    const double radial = 1 + r2 * (lens.k1 + r2 * (lens.k2 + r2 * lens.k3));
    return {n.x * radial + 2 * lens.p1 * n.x * n.y + lens.p2 * (r2 + 2 * n.x * n.x),
            n.y * radial + lens.p1 * (r2 + 2 * n.y * n.y) + 2 * lens.p2 * n.x * n.y};
}

}  // namespace

Lens pinhole(const Lens& lens) {
    return {lens.width, lens.height, lens.fx, lens.fy, lens.cx, lens.cy};
}

Lens scaled(const Lens& lens, int width, int height) {
    const double sx = double(width) / lens.width;
    const double sy = double(height) / lens.height;
    Lens result = lens;
    result.width = width;
    result.height = height;
    result.fx = lens.fx * sx;
    result.fy = lens.fy * sy;
    result.cx = (lens.cx + 0.5) * sx - 0.5;
    result.cy = (lens.cy + 0.5) * sy - 0.5;
    return result;
}

glm::dvec2 project(const Lens& lens, const glm::dvec3& p_camera) {
    const glm::dvec2 ideal{p_camera.x / p_camera.z, p_camera.y / p_camera.z};
    const glm::dvec2 n = distorted(lens) ? distort(lens, ideal) : ideal;
    return {lens.fx * n.x + lens.cx, lens.fy * n.y + lens.cy};
}

glm::dvec3 unproject(const Lens& lens, const glm::dvec2& pixel) {
    const glm::dvec2 measured{(pixel.x - lens.cx) / lens.fx, (pixel.y - lens.cy) / lens.fy};
    glm::dvec2 n = measured;
    if (distorted(lens)) {
        for (int i = 0; i < 50; ++i) {
            const glm::dvec2 step = measured - distort(lens, n);
            n += step;
            if (glm::dot(step, step) < 1e-20) break;
        }
    }
    return {n.x, n.y, 1.0};
}

std::optional<glm::ivec2> nearest_pixel(const Lens& lens, const glm::dvec2& position) {
    const double x = std::floor(position.x + 0.5);
    const double y = std::floor(position.y + 0.5);
    if (!(x >= 0 && y >= 0 && x < lens.width && y < lens.height)) return std::nullopt;
    return glm::ivec2(int(x), int(y));
}

}  // namespace inlay
