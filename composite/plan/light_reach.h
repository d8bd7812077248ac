// How much of the light on what is seen a virtual object can change at most, from where it stands.
#pragma once

#include "composite/plan/object_in_view.h"
#include "recordings/base/environment_map.h"

#include <glm/glm.hpp>

#include <limits>

namespace inlay {

/// Half a code of 8-bit sRGB is a change of linear light by this share at least: that from 255 down
/// to 254.5; all other codes take more.
inline constexpr double half_code = 0.00445;

/// Share of the mean light that surfaces which are seen are taken to get at least. A darker one
/// keeps its bytes too, as long as it reflects no more than it gets: its radiance changes by 9e-5
/// of full white, and half a code is 1.5e-4 at least. What shines by itself in the dark (a screen,
/// a lamp) does not: the composite takes it for a surface, and may be a code off there.
inline constexpr double least_light = 0.02;

/// A change of the light by a smaller share of its mean moves no byte, as long as that holds.
inline constexpr double unseen_change = half_code * least_light;

/// Radiance from all directions, for each channel.
struct LightRange {
    Rgb mean{0};
    Rgb brightest{0};
};

LightRange light_range(const EnvironmentMap& environment);

/// The brightest light that may come from anywhere or be put there, over the mean light on what is
/// seen: the larger for the channels. Real surfaces may be as bright as full white at the
/// photograph's exposure (relative to the reference) or at the reference itself, and virtual ones
/// as bright as what they reflect. Light that is brighter than white on average counts as white,
/// since walls may keep it off. Infinite where a channel has no light.
double contrast(const LightRange& environment, const Rgb& exposure);

/// Where real surfaces are seen: a frustum with its apex in the camera (camera frame).
struct SeenSpace {
    ViewWindow window;
    double farthest = std::numeric_limits<double>::infinity();  // m, along z
    double offset = 0;  // m, off a surface, where its rays start
};

/// From the nearest point of the frustum to `point` (m, camera frame); 0 where the window has no
/// bounds.
double distance_to(const SeenSpace& seen, const glm::dvec3& point);

/// Share of an even sky's irradiance that a ball hides at most from a surface in the seen space,
/// however that is turned: the sphere's view factor, sin^2 of the angular radius; all of it where
/// the two may touch.
double hidden_share(const Ball& ball, const SeenSpace& seen);

/// By which share of its mean a ball changes the light on what is seen, at most: it takes no more
/// than the brightest light from where it stands, and adds no more. Of light as it is simulated:
/// what real surfaces send is not lit anew.
double light_change(const Ball& ball, const SeenSpace& seen, double contrast);

}  // namespace inlay
