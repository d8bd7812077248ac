// Baseline: non-local means, which averages pixels whose surroundings look alike.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

struct NonLocalMeansSettings {
    int search_radius = 7;  // px, 1..50, each way
    int patch_radius = 1;   // px, 0..10, each way
};

/// Buades et al. 2005: weights exp(-max(d^2 - 2 s^2, 0) / (h s)^2) with d^2 the mean square
/// difference of luminance over two patches, s^2 the noise's variance (the median over receivers of
/// the variance within 7 x 7 pixels), and h = `strength` > 0. One set of weights for all images of
/// a receiver and a light, from E_RV. It keeps shadows that rise above the noise, and knows neither
/// normals nor depth. Its time grows as the square of the search radius.
Layers non_local_means(const NoisyLayers& now, double strength,
                       const NonLocalMeansSettings& settings = {});

}  // namespace inlay
