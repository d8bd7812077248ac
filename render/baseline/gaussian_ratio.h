// Baseline: a compositor's blur node on the ratio image E_RV / E_R.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

struct RatioBounds {
    double epsilon_share = 1e-3;  // of the frame's mean E_R, added to both sides; > 0
    double max_ratio = 4;         // >= 1
};

/// On real receivers the ratio of direct and indirect light together, bounded per pixel, under a
/// Gaussian of `sigma` (px, > 0); virtual receivers as gaussian_irradiance. Shading that both modes
/// share cancels before the blur, so only changes of light lose their edges.
/// The ratio is handed on as direct E_RV_real over a direct E_R of 1, with no indirect light, so
/// that eq. 6.2 multiplies by it; an epsilon of the compositor moves it towards 1 by that share.
/// Where both modes are equal to the bit within the kernel, both results are 1.
Layers gaussian_ratio(const NoisyLayers& now, double sigma, const RatioBounds& bounds = {});

}  // namespace inlay
