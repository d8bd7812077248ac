// The rays that the thesis takes for a frame, for each mode in one scene of its own.
#pragma once

#include "composite/accuracy/tracked_frame.h"

#include "apps/bench/bare_embree.h"

namespace inlay {

/// Per pixel 4 camera rays, 4 shadow and 4 indirect rays from each surface that one meets, and a
/// shadow ray from each surface that an indirect one meets (Mehta 2015, Algorithm 1). Shadow rays
/// ask for any hit. `whole` is what the mode's rays meet; without `objects` it is real geometry.
BareRays thesis_rays(const Work& work, const TrackedFrame& frame, const EmbreeScene* objects,
                     const BareScene& whole);

}  // namespace inlay
