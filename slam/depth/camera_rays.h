// The ray of every pixel of a lens, computed once per lens.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"

#include <glm/glm.hpp>

#include <memory>

namespace inlay {

/// Directions with z = 1 through the pixel centres (camera frame): z-depth times them is the point.
/// Undistorting is slow, so the tables of the lenses used last are kept and shared; what a caller
/// gets depends on the lens alone.
std::shared_ptr<const Image<glm::vec3>> camera_rays(const Lens& lens);

}  // namespace inlay
