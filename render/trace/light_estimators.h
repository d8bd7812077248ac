// The three estimators of the two-mode sampler: environment light through shadow rays, one bounce
// along the cosine lobe, and light along glossy lobes. Each serves both modes from the same rays.
#pragma once

#include "render/trace/landing.h"
#include "render/trace/pixel_sums.h"
#include "render/trace/ray_counts.h"
#include "render/trace/two_mode_sampler.h"

namespace inlay {

/// One sample of 16 pixels, with everything that its estimators share and add to.
struct SamplePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const Landings& landings;
    SampleKeys keys;
    std::array<PixelSums, packet_width>& sums;
    RayCounts& rays;
};

/// Environment light: E_dir of both modes, and the glossy lobe's share of it. cos / pdf weights; an
/// environment sample below the surface counts as 0.
void add_direct(SamplePass& pass);

/// One bounce along the cosine lobe: E_ind of both modes. cos / pdf = pi, which Mehta 2015,
/// Algorithm 1 leaves out.
void add_indirect(SamplePass& pass);

/// Light along the glossy lobe of virtual surfaces: what it meets, and its share of the
/// environment.
void add_glossy(SamplePass& pass);

}  // namespace inlay
