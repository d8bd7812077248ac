// E_R for itself: light on real surfaces from real geometry alone.
#pragma once

#include "render/trace/sample_pass.h"

namespace inlay {

/// Samples of E_R per camera ray where it is sampled for itself: a quarter of settings.secondary,
/// and one at least.
int real_light_samples(const SamplingSettings& settings);

/// One sample of the environment's light on real surfaces, shadowed by real geometry.
void add_real_direct(SamplePass& pass);

/// One bounce along the cosine lobe of real surfaces, which meets real geometry alone.
void add_real_indirect(SamplePass& pass);

}  // namespace inlay
