// Baseline: the guided filter, whose output is locally linear in the normals.
#pragma once

#include "render/trace/layers.h"

namespace inlay {

/// He et al. 2013 with the normal as the guide: within each square of `radius` px (1..1000) the
/// irradiance is fitted as a . n + b, with `epsilon` > 0 (1, square of a difference of normals) as
/// what keeps a small; fits are averaged over the squares that hold a pixel. Squares count their
/// receivers alone. Shading by the normal survives as far as it is linear; shadows blur; surfaces
/// with the same normal at different depths mix. Its time does not depend on the radius. Negative
/// overshoot becomes 0.
Layers guided_filter(const NoisyLayers& now, int radius, double epsilon = 1e-3);

}  // namespace inlay
