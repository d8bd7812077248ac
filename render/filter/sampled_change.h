// What the filter smooths where E_RV - E_R was sampled for itself.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

/// E_RV - E_R on real surfaces, of one kind of light.
Image<Rgb> change_of(const Irradiance& light);

/// E_R + change, 0 at least: few samples of E_R may bring less than is taken away.
Image<Rgb> with_change(const Image<Rgb>& e_r, const Image<Rgb>& change);

/// The real receivers with the rates of that change in the place of those of E_R.
Receiver receiver_of_change(const NoisyLayers& layers);

}  // namespace inlay
