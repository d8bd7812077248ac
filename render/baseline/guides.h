// What tells surfaces and noise apart: exponents from normals and depth, luminance and its spread.
#pragma once

#include "render/baseline/neighborhood.h"

#include <glm/glm.hpp>

namespace inlay {

/// How far two surfaces may differ before they no longer mix.
struct SurfaceGuide {
    double normal_sigma = 0.1;  // of the difference between unit normals, > 0; 0.1 is 5.7 degrees
    double depth_share = 0.01;  // of the distance to the camera: sigma off the tangent plane; > 0
};

/// Throws Error(usage) that names the setting which is out of its range.
void validate(const SurfaceGuide& guide);

/// |n - n'|^2 / (2 sigma_n^2) + (n (p' - p))^2 / (2 sigma_d^2). Depth counts as the distance from
/// the pixel's tangent plane, so that slanted planes are no edges. `planes` must outlive it.
AddExponents surface_exponents(const FilterPlanes& planes, const glm::dvec3& camera_position,
                               const SurfaceGuide& guide);

/// Luminance of the last image of `planes`, E_RV: it has all the edges that E_R has, and the
/// shadows of virtual objects too. 1e15 at most, so that squares stay finite.
Image<float> guide_luminance(const FilterPlanes& planes);

/// Variance of `luminance` over the 7 x 7 pixels around each, weighted by `add_exponents`.
Image<float> local_variance(const Image<std::uint32_t>& object, const Image<float>& luminance,
                            const AddExponents& add_exponents);

}  // namespace inlay
