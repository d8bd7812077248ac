// How fast irradiance changes along a surface (1/m), and how wide a filter that allows.
#pragma once

#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"

#include <glm/glm.hpp>

namespace inlay {

/// B_f (1/rad): holds 99 % of the clamped cosine's energy. Mehta 2015, fig. 6.5 takes 1 (70 %).
constexpr double cosine_bandlimit = 2.36;
/// Larger bandwidths (1/m), and NaN, count as this.
constexpr double largest_bandwidth = 1e9;

/// What decides a pixel's bandwidth, along one image axis.
struct LocalFrequencies {
    double curvature = 0;    // kappa, 1/m, positive where convex
    double occluder = 0;     // c, 1/m: the largest cos/r over blocked rays, 0: none
    double environment = 0;  // B_e, 1/rad
    double glossy = 0;       // B_rho, 1/rad, 0: diffuse
};

/// `bandwidth` within 0 .. largest_bandwidth; NaN becomes the largest: what is unknown is not
/// smoothed.
double clamped_bandwidth(double bandwidth);

/// c of one blocked ray (1/m): cos^2/z of Mehta 2015, eq. 6.8, where z is the depth of the occluder
/// perpendicular to the receiver, which is cos/r for a hit at distance `r` (m, > 0). With r in the
/// place of z the printed formula gives cos^2/r, too small by a factor of cos.
double occluder_rate(double cosine, double r);

/// Bandwidth (1/m) of direct light: the support of eq. 6.11's spectrum with signed curvature,
/// |kappa + c| (B_f + B_rho) ... : B = |kappa + c| B_f + |2 kappa + c| B_rho + c B_e. Mehta 2015,
/// eq. 6.17 counts B_rho twice in the occluder's term, and eq. 6.13 fails where kappa < 0.
/// |kappa + c| is at least c / 10.
double direct_bandwidth(const LocalFrequencies& f);

/// B_h (1), for which c B_h is the bandwidth of light from surfaces nearby: 99 % of the energy of
/// the receiver's transfer function in a square, sqrt(3.65^2 + 3.93 n) for a Phong lobe of exponent
/// n = (B_rho / 1.82)^2. Mehta 2015, sec. 6.6.5 takes 2.8 (96 %) and 4.27 + 0.15 n.
double transfer_bandlimit(double glossy);

/// Bandwidth (1/m) of indirect light: |kappa| B_f + |2 kappa| B_rho + c B_h. Mehta 2015, eq. 6.18
/// with cos/r in place of 1 / z_min; differs: a curved receiver changes it too.
double indirect_bandwidth(const LocalFrequencies& f);

/// Mehta 2015, eq. 6.17 (6.13 where B_rho = 0) with B_f = 1, as printed.
double thesis_direct_bandwidth(const LocalFrequencies& f);

/// Mehta 2015, eq. 6.18 with B_h = 2.8 (diffuse) or 4.27 + 0.15 n (glossy), as printed.
double thesis_indirect_bandwidth(const LocalFrequencies& f);

/// |2 kappa + c| B_rho with B_f = 1 in the place of B_rho where diffuse: Durand et al. 2005, eq. 21
/// as Mehta 2015, eq. 6.19 has it, for direct and indirect light alike. It leaves out how fast the
/// light itself changes. Differs: the absolute value, since kappa may be negative.
double durand_bandwidth(const LocalFrequencies& f);

enum class LightKind { direct, indirect };

/// 1 / sigma (1/m) of the filter's Gaussian exp(-d^2 / (2 sigma^2)) at 16 samples per pixel.
/// Corrected: |kappa| B_f / s_k + c (B_f + B_e) / s_v + (2 |kappa| / s_k + c / s_v) B_rho, and for
/// indirect light |kappa| (B_f + 2 B_rho) / s_k + c B_h / s_v. The two terms need safety factors of
/// their own: a sphere's irradiance of degree l is damped by exp(-l (l + 1) (sigma kappa)^2 / 2),
/// whereas the occluder's term is a loose bound.
/// Thesis and Durand: 2 B, since eq. 6.23 is exp(-2 B^2 d^2). 0 where nothing bounds the width.
double inverse_width(const LocalFrequencies& f, LightKind light, const FilterSettings& settings);

/// g = (16 / samples)^(1/4), by which sigma is multiplied so that the error vanishes as `samples`
/// (per pixel, counts as 1 at least) grow; 1 unless the constants are corrected: the thesis has no
/// such factor.
double sample_factor(int samples, const FilterSettings& settings);

/// Curvature (1/m) of the surface between two of its points: the angle between the unit normals
/// over the distance, at least a quarter of `footprint` (m, the size of a pixel). Positive where
/// convex: where the normals spread. Mehta 2015, eq. 6.20; differs: the angle is by atan2, since
/// acos gives 0 for angles below 3e-4 in single precision; the sign, (n' - n).(p' - p), is that of
/// the text above eq. 6.5, and does not depend on noise of the positions along the normal.
double pair_curvature(const glm::vec3& p, const glm::vec3& n, const glm::vec3& p_next,
                      const glm::vec3& n_next, double footprint);

/// Curvature (1/m) along both image axes, 0 where no neighbor tells.
struct ScreenCurvature {
    Image<float> x, y;
};

/// Per pixel the median of pair_curvature over its 3x3 neighbors of the same object, each paired
/// with the next pixel of its row (x) or column (y). Pairs across depth edges, which lie more than
/// 30 degrees and two pixels out of their mean tangent plane, are left out.
ScreenCurvature screen_curvature(const Receiver& receiver, const Image<float>& footprint);

/// Size (m) of a pixel at the depth of each receiver, without foreshortening; 0 where none is.
Image<float> pixel_footprint(const Receiver& receiver, const Lens& lens,
                             const Pose& world_from_camera);

}  // namespace inlay
