// Baseline: the edge-avoiding a-trous wavelet filter with a variance estimate.
#pragma once

#include "render/baseline/guides.h"
#include "render/trace/layers.h"

namespace inlay {

struct ATrousSettings {
    SurfaceGuide surface{0.0884, 0.01};  // exp(-|n - n'|^2 64), close to cos^128
    double luminance_sigma = 4;          // in standard deviations, > 0
};

/// The spatial part of Schied et al. 2017 ("Spatiotemporal Variance-Guided Filtering", secs. 4.3
/// and 4.4): `levels` (1..5) passes of the 5 x 5 B3 spline at steps of 1, 2, 4, .. px, stopped at
/// normals, depth, and luminance that differs by more than the noise explains. The noise is
/// estimated over 7 x 7 pixels of the input and filtered along, squared weights and all.
/// Differs: depth is the distance from the tangent plane (guides.h), and the luminance is E_RV's
/// for all images of a receiver.
Layers a_trous(const NoisyLayers& now, int levels, const ATrousSettings& settings = {});

}  // namespace inlay
