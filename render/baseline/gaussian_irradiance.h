// Baseline: every irradiance under the same Gaussian blur.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

/// A Gaussian of `sigma` (px, > 0) over each irradiance, among the pixels of its own kind of
/// receiver (see smooth_receivers). It knows no edges: shadows, objects and corners blur alike.
Layers gaussian_irradiance(const NoisyLayers& now, double sigma);

}  // namespace inlay
