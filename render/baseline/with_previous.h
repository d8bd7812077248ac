// The previous frame's samples for any method: noisy layers in, less noisy layers out.
#pragma once

#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"

namespace inlay {

/// `now` with each irradiance (and unshadowed light, if both frames have it) averaged with
/// `previous` where its camera saw the same place of the same object (see matching_pixels; the
/// settings give its limits), each frame by its number of samples on that kind of receiver; other
/// pixels, and all other layers, keep their own. Right as long as neither lights nor objects moved.
/// A value of the previous frame that is not finite is not used. E_R and E_RV share their weights.
/// Throws Error when the sizes of a frame do not match or a setting is out of its range.
NoisyLayers with_previous(const NoisyLayers& now, const NoisyLayers& previous,
                          const FilterSettings& settings);

}  // namespace inlay
