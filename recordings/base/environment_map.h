// EnvironmentMap: distant light in latitude-longitude layout, and its direction <-> pixel mapping.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <glm/glm.hpp>

namespace inlay {

/// Radiance from each direction. Layout as OpenEXR's latitude-longitude maps: in the map's frame +y
/// is up, the image's centre looks along +z, its left quarter along +x. Row y covers the polar
/// angles pi y / height .. pi (y + 1) / height, and radiance is constant within a texel.
struct EnvironmentMap {
    Image<Rgb> radiance;                     // finite and >= 0
    glm::dmat3 world_from_environment{1.0};  // rotation
};

/// Image position in texel units (x in [0, width), y in [0, height]; texel (i, j) covers [i, i+1) x
/// [j, j+1)) of a unit direction in the map's own frame.
glm::dvec2 texel_from_direction(const Image<Rgb>& map, const glm::dvec3& direction_map);

/// Unit direction, in the map's own frame, of an image position in texel units.
glm::dvec3 direction_from_texel(const Image<Rgb>& map, const glm::dvec2& texel);

/// Solid angle (sr) of each texel of row `y`; they sum to 4 pi over the map.
double texel_solid_angle(const Image<Rgb>& map, int y);

/// Radiance that arrives from a unit direction (world).
Rgb radiance_from(const EnvironmentMap& environment, const glm::vec3& direction_world);

}  // namespace inlay
