// B_e: how fast an environment map changes with direction.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <vector>

namespace inlay {

/// Degrees of spherical harmonics that environment_bandwidth looks at: 0 .. this - 1.
constexpr int environment_degrees = 64;

/// The power S_l = sum over m of |L_lm|^2 of a latitude-longitude map's luminance, for the degrees
/// l = 0 .. environment_degrees - 1. Does not change when the map is rotated, beyond what the
/// texels themselves do to it. Maps of more than 256 rows or 512 columns are averaged down by
/// solid angle first. Non-finite texels count as black; an empty map has no power.
std::vector<double> spherical_harmonic_powers(const Image<Rgb>& radiance);

/// B_e (1/rad): the smallest degree such that the degrees 1 .. B_e hold the share `energy` (0..1)
/// of the luminance's power without its mean. 0 for maps that are constant: everything but the mean
/// is less than a millionth of the mean's power.
/// Mehta 2015, sec. 6.7 takes the 2D Fourier spectrum of the map in its latitude-longitude layout
/// instead, which changes (4 to 62 for the same lobe) with the lobe's distance from the pole.
double environment_bandwidth(const Image<Rgb>& radiance, double energy = 0.99);

}  // namespace inlay
