// Follows rays through a surface map in the image: real geometry for one frame, without a mesh.
#pragma once

#include "render/trace/image_ray.h"

namespace inlay {

enum class ScreenStatus {
    hit,
    missed,     // stays in the image for ever and meets nothing
    off_screen  // leaves the image or goes behind the camera: what it meets there is unknown
};

struct ScreenHit {
    ScreenStatus status = ScreenStatus::missed;
    glm::ivec2 pixel{0};       // of the surface, if hit
    double distance = 0;       // m, along the ray, if hit
    glm::dvec3 position{0.0};  // m, camera coordinates, if hit
};

/// The first slab of the map that the ray meets (Mehta 2015, sec. 6.5: a hierarchical walk over the
/// frame's vertex map). Every pixel that the ray crosses is tested or proven free, so nothing is
/// stepped over, and rays pass behind surfaces that are thinner than the gap.
/// A ray whose start lies within the slab of its own pixel is not stopped in that pixel: it has
/// started on that surface, and only the map's noise puts it inside. All other tests are exact, so
/// nearby occluders keep their contact shadows. `ray` must be finite.
ScreenHit trace_screen(const DepthPyramid& map, const CameraRay& ray);

/// The same by testing every pixel of every row that the ray crosses: the slow reference.
ScreenHit trace_screen_exhaustively(const DepthPyramid& map, const CameraRay& ray);

}  // namespace inlay
