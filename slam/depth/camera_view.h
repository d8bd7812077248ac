// What a lens sees: the ray of every pixel, and the pixel of every point, made for tight loops.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lanes.h"
#include "recordings/base/lens.h"

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <memory>

namespace inlay {

/// Which of eight points are seen, and at which pixels.
struct SeenAt {
    Lanes seen;
    std::array<int, lane_count> pixel;
};

/// A lens with its table of rays.
struct CameraView {
    Lens lens;
    bool bent = false;                             // the lens has distortion
    std::shared_ptr<const Image<glm::vec3>> rays;  // z = 1: z-depth times a ray is the point
    glm::vec2 lowest{0}, highest{0};               // bounds of the rays' x and y

    /// Index of the pixel where a point (m, camera frame) appears, -1 where none does. Points
    /// beyond the outermost rays have none, however the distortion might fold them back.
    int pixel_of(const glm::vec3& p_camera) const;

    /// The same for eight points, with pixel 0 for those that have none.
    SeenAt pixels_of(const Vectors& p_camera) const;

    /// False if no point of a ball (m, camera frame) can be seen.
    bool may_see(const glm::vec3& centre, float radius) const;
};

/// The view of a lens. Undistorting is slow, so the tables of the lenses used last are kept and
/// shared; what a caller gets depends on the lens alone.
CameraView camera_view(const Lens& lens);

inline int CameraView::pixel_of(const glm::vec3& p) const {
    if (!(p.z > 0)) return -1;
    const float x = p.x / p.z, y = p.y / p.z;
    if (!(x >= lowest.x && y >= lowest.y && x <= highest.x && y <= highest.y)) return -1;
    glm::vec2 position(float(lens.fx) * x + float(lens.cx), float(lens.fy) * y + float(lens.cy));
    if (bent) position = glm::vec2(project(lens, {x, y, 1.0}));
    const int column = int(position.x + 1.5f) - 1, row = int(position.y + 1.5f) - 1;
    if (column < 0 || row < 0 || column >= lens.width || row >= lens.height) return -1;
    return row * lens.width + column;
}

inline bool CameraView::may_see(const glm::vec3& centre, float radius) const {
    if (centre.z + radius <= 0) return false;
    const auto beyond = [&](float edge, float along, float sign) {
        return sign * (along - edge * centre.z) > radius * std::sqrt(1 + edge * edge);
    };
    return !beyond(highest.x, centre.x, 1) && !beyond(lowest.x, centre.x, -1) &&
           !beyond(highest.y, centre.y, 1) && !beyond(lowest.y, centre.y, -1);
}

}  // namespace inlay
