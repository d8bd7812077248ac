// LightNeed: how well E_R has to be known where virtual geometry changes the light by so much.
#pragma once

#include "render/trace/layers.h"

#include <cstddef>
#include <cstdint>

namespace inlay {

/// The composite shows E_R only by its ratio to the change: hardly, if that is small.
enum class LightNeed : std::uint8_t { hardly, slight, plain };
inline constexpr std::size_t light_need_count = 3;

/// Of a real surface of which virtual surfaces hide the share `hidden` of an even sky, and whose
/// direct light changes by `change`, under an environment of `mean_luminance`. What virtual
/// surfaces are made of does not matter.
LightNeed light_need(float hidden, const Rgb& change, float mean_luminance);

/// Of each pixel, before E_R is known (0) and after all else was sampled. A pixel with few
/// neighbors that a filter could mix it with has to rely on its own samples, so it needs all of
/// them: a single sample is often 0, and a ratio to that is not light.
Image<LightNeed> light_needs(const NoisyLayers& layers, float mean_luminance);

/// All of `most` samples for a plain need; a quarter for a slight one; else a sixteenth, for the
/// neighbors to filter with. One at least.
int samples_for(LightNeed need, int most);

}  // namespace inlay
