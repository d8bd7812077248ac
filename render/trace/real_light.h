// E_R for itself: light on real surfaces from real geometry alone.
#pragma once

#include "render/trace/sample_pass.h"

namespace inlay {

/// A number for each pixel of a tile.
using LaneCounts = std::array<int, packet_width>;

/// Samples of E_R per camera ray, where it is sampled for itself, in a pixel with this `change`,
/// which must be complete: settings.secondary if it is large enough to be seen, since the ratio to
/// E_R is shown there; else a quarter of that, for the neighbours to filter with. One at least.
int real_light_samples(const TwoModeScene& scene, const SamplingSettings& settings,
                       const ChangeSums& change);
int most_real_light_samples(const SamplingSettings& settings);

/// One sample of the environment's light on real surfaces, shadowed by real geometry. `counts` are
/// the samples that each pixel takes per camera ray.
void add_real_direct(SamplePass& pass, const LaneCounts& counts);

/// One bounce along the cosine lobe of real surfaces, which meets real geometry alone.
void add_real_indirect(SamplePass& pass);

}  // namespace inlay
