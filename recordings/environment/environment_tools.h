// Environment maps made from a description, turned, scaled and measured.
#pragma once

#include "recordings/base/environment_map.h"

#include <glm/glm.hpp>

#include <vector>

namespace inlay {

/// A spherical Gaussian: radiance exp(sharpness (cos - 1)) at the angle whose cosine is `cos` from
/// `direction`.
struct GaussianLobe {
    glm::dvec3 direction{0, 1, 0};  // unit, in the map's frame
    double sharpness = 10;          // 0..1e5, 1
    Rgb radiance{1};                // at the centre
};

/// The same radiance from everywhere.
Image<Rgb> make_constant(const Rgb& radiance);

/// `ambient` plus the sum of the lobes, 256 x 128. A texel holds the mean over its solid angle, so
/// that a lobe's power is 2 pi (1 - exp(-2 sharpness)) / sharpness times its radiance.
Image<Rgb> make_lobes(const Rgb& ambient, const std::vector<GaussianLobe>& lobes);

/// The map times a factor.
Image<Rgb> scaled(const Image<Rgb>& radiance, float factor);

/// world_from_environment that turns the map's +y to `up_world` and its +z to the horizontal part
/// of `forward_world` (neither need be unit), then turns the map by `rotate_deg` about up,
/// counter-clockwise seen from above. Where forward is parallel to up, the horizontal part of the
/// world's +z takes its place, or of its +x.
glm::dmat3 align_environment(const glm::dvec3& up_world, const glm::dvec3& forward_world,
                             double rotate_deg);

/// Radiance averaged over the sphere of directions.
Rgb mean_radiance(const Image<Rgb>& map);

/// Irradiance on an unoccluded surface with a unit normal (world): the sum over all texels of
/// radiance times the cosine-weighted solid angle above the horizon. In closed form for texels that
/// lie wholly above it, by 32 x 32 points in those that it cuts. Slow: a reference for tests.
Rgb irradiance_from_environment(const EnvironmentMap& environment, const glm::dvec3& normal_world);

}  // namespace inlay
