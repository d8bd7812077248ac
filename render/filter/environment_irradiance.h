// EnvironmentIrradiance: what an unoccluded surface receives from an environment, for any normal.
#pragma once

#include "recordings/base/environment_map.h"

#include <glm/glm.hpp>

namespace inlay {

/// Irradiance by normal in latitude-longitude layout, with rows on both poles (row y at the polar
/// angle pi y / (height - 1)) and columns at the longitudes 2 pi (1/2 - x / width).
struct EnvironmentIrradiance {
    Image<Rgb> by_normal;  // relative radiance times sr
    glm::dmat3 world_from_environment{1.0};
};

/// Sums the clamped cosine over the map, at 128 x 65 normals. Maps larger than 128 x 64 are
/// averaged down by solid angle first; of a wide light, what remains of the error is below 1e-3 of
/// the largest irradiance, of a single bright texel up to 2e-2. Texels that are not finite count as
/// black. Throws Error for an empty map.
EnvironmentIrradiance make_environment_irradiance(const EnvironmentMap& environment);

/// Irradiance of a unit normal (world), bilinear between the normals of the table; never negative.
Rgb irradiance_on(const EnvironmentIrradiance& irradiance, const glm::vec3& normal_world);

}  // namespace inlay
