// The shadow ratio: light that is smoothed as a share of what an open sky would send.
#pragma once

#include "recordings/base/image.h"
#include "render/filter/environment_irradiance.h"
#include "render/trace/layers.h"

namespace inlay {

/// Makes irradiance of the smoothed `light` and the equally smoothed light without shadows, U, for
/// each receiver with the normal n: E -> E_unocc(n) E / U; 0 where U is. Images of one size.
void scale_to_open_sky(const EnvironmentIrradiance& open_sky, const Receiver& receiver,
                       const Image<Rgb>& unshadowed, Image<Rgb>& light);

}  // namespace inlay
