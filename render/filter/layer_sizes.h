// Do the images of a frame's noisy layers fit each other?
#pragma once

#include "render/trace/layers.h"

namespace inlay {

/// Throws Error that names the image unless every image has the lens's size. Those of virtual
/// surfaces may be absent (k_v empty), and those of glossy ones (s_rv empty).
void require_layer_sizes(const NoisyLayers& layers);

/// The same for unshadowed light, which may be absent.
void require_unshadowed(const NoisyLayers& layers);

}  // namespace inlay
