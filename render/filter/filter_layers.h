// NoisyLayers -> Layers: each irradiance smoothed with the width that its light allows.
#pragma once

#include "render/filter/environment_irradiance.h"
#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"

namespace inlay {

/// Smooths the irradiances and S_RV of `now`; M and k_V pass unchanged.
/// E_R and E_RV_real of a pixel share one width and the same weights, so that they stay equal to
/// the bit where all their inputs are; where the change was sampled for itself, E_R and E_RV_real -
/// E_R have a width each, and the same holds; E_RV_virtual has the virtual receiver's, S_RV the
/// glossy one's; direct and indirect light have their own. Pixels without a receiver of the kind,
/// or with a value that is not finite, are 0 and never used. S_RV is kept as it is where B_rho is
/// 0. `previous`, the frame before (or null), adds its unfiltered values (Mehta 2015,
/// eqs. 6.24-6.26) at the pixels that its own camera sees the same surface at, and nowhere else;
/// pass null when the lights moved; one that was sampled by another estimator adds nothing, and E_R
/// that was sampled for itself does without it. S_RV
/// does without, since it changes with the camera. `environment_bandwidth` is B_e (1/rad, see
/// environment_bandwidth.h). bandwidth_direct and bandwidth_indirect hold 1 / sigma (1/m), mean of
/// both axes, of the kind of receiver that covers more of the pixel; 0: no receiver, or only the
/// kernel's radius is a limit. With `open_sky` direct light is smoothed as a shadow ratio: E =
/// E_unocc(n) filt(E) / filt(U), where U are the same samples without shadows and E_unocc is the
/// irradiance of `open_sky`, 0 where filt(U) is. Curvature does not narrow that filter, since the
/// normal acts through E_unocc alone. It takes NoisyLayers::unshadowed, and trusts that the map is
/// what the samples were drawn from. Throws Error when sizes do not match, a focal length is 0, B_e
/// is not finite or negative, a setting is out of its range, or unshadowed light is missing.
Layers filter_layers(const NoisyLayers& now, const NoisyLayers* previous,
                     double environment_bandwidth, const FilterSettings& settings,
                     const EnvironmentIrradiance* open_sky = nullptr);

}  // namespace inlay
