// SurfaceMap: position and normal per pixel; where slam and render meet.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace inlay {

/// What a pixel at an edge sees beside its own surface: a half-plane of the image.
struct SecondSurface {
    glm::vec3 position{0};  // m, camera frame; z = 0: nothing is known of it
    glm::vec3 normal{0};    // unit, camera frame, towards the camera
    glm::vec2 towards{0};   // unit, in the image, from the pixel's own surface to this one
    float edge = 0.5f;      // px, along `towards` from the pixel's center, where it begins
};

/// The pixels that see two surfaces. Empty: none does.
struct SplitPixels {
    Image<std::uint32_t> number;  // 0: one surface; else 1 + the place in `second`
    std::vector<SecondSurface> second;
};

/// The real surface seen through each pixel. All images have the lens's size.
struct SurfaceMap {
    Lens lens;
    Pose world_from_camera;
    Image<glm::vec3> position;  // m, camera frame; z = 0: no surface is known here
    Image<glm::vec3> normal;  // unit, camera frame, towards the camera; 0 where position is a hole
    Image<float> confidence;  // 0..1
    SplitPixels split{};

    bool has_surface(int x, int y) const { return position(x, y).z > 0; }
};

/// A map of `lens`'s size that holds nothing but holes.
inline SurfaceMap empty_surface_map(const Lens& lens, const Pose& world_from_camera) {
    return {lens, world_from_camera, Image<glm::vec3>(lens.width, lens.height, glm::vec3(0)),
            Image<glm::vec3>(lens.width, lens.height, glm::vec3(0)),
            Image<float>(lens.width, lens.height, 0.0f)};
}

}  // namespace inlay
