// The three estimators of the two-mode sampler: environment light through shadow rays, one bounce
// along the cosine lobe, and light along glossy lobes. Each serves both modes from the same rays.
#pragma once

#include "render/trace/sample_pass.h"

namespace inlay {

/// Environment light: E_dir of both modes, and the glossy lobe's share of it. cos / pdf weights; an
/// environment sample below the surface counts as 0.
void add_direct(SamplePass& pass);

/// One bounce along the cosine lobe: E_ind of both modes. cos / pdf = pi, which Mehta 2015,
/// Algorithm 1 leaves out.
void add_indirect(SamplePass& pass);

/// Light along the glossy lobe of virtual surfaces: what it meets, and its share of the
/// environment.
void add_glossy(SamplePass& pass);

/// The pixels (a bit mask) in which the rays of add_direct or add_indirect from a real surface meet
/// virtual geometry, whether or not real geometry is nearer.
std::uint32_t lanes_meeting_virtual(SamplePass& pass);

}  // namespace inlay
