// Baseline: the joint (cross) bilateral filter, guided by normals and depth.
#pragma once

#include "render/baseline/guides.h"
#include "render/trace/layers.h"

namespace inlay {

/// A Gaussian of `sigma` (px, > 0), cut at 2 sigma, times the weights of the guide (Petschnigg et
/// al. 2004; Eisemann and Durand 2004). It stops at corners and objects, and blurs shadows. Not
/// separable: its time grows as sigma^2.
Layers joint_bilateral(const NoisyLayers& now, double sigma, const SurfaceGuide& guide = {});

}  // namespace inlay
