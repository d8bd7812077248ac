// IrradianceError: how far E_R and E_RV are from those of the true room, each by itself.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

/// Two independent estimates of a frame's light.
struct LightPair {
    const Layers& a;
    const Layers& b;
};

/// Relative RMSE of irradiances against those of the true room, over pixels that real surfaces
/// cover whole: root of the mean square error over that of the reference. The noise of `wanted`
/// drops out, and that of `found` where its two estimates are not one and the same.
struct IrradianceError {
    double e_r = 0, e_rv = 0;
    double compared = 0;  // share of the pixels that real surfaces cover whole; the rest are holes
};
IrradianceError irradiance_error(const LightPair& found, const LightPair& wanted);

/// Relative RMS change of an irradiance where the image moves by `px`, as displaced_mean_square().
double displaced_irradiance(const LightPair& light, Image<Rgb> Irradiance::*kind, double px);

}  // namespace inlay
