// SurfaceMap: position and normal per pixel; where slam and render meet.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <glm/glm.hpp>

namespace inlay {

/// The real surface seen through each pixel. All images have the lens's size.
struct SurfaceMap {
    Lens lens;
    Pose world_from_camera;
    Image<glm::vec3> position;  // m, camera frame; z = 0: no surface is known here
    Image<glm::vec3> normal;  // unit, camera frame, towards the camera; 0 where position is a hole
    Image<float> confidence;  // 0..1

    bool has_surface(int x, int y) const { return position(x, y).z > 0; }
};

/// A map of `lens`'s size that holds nothing but holes.
inline SurfaceMap empty_surface_map(const Lens& lens, const Pose& world_from_camera) {
    return {lens, world_from_camera, Image<glm::vec3>(lens.width, lens.height, glm::vec3(0)),
            Image<glm::vec3>(lens.width, lens.height, glm::vec3(0)),
            Image<float>(lens.width, lens.height, 0.0f)};
}

}  // namespace inlay
