// The difference form of the light on real surfaces: E_RV - E_R is an integral over the directions
// in which virtual geometry is nearest, and over nothing else.
#pragma once

#include "render/sample/light_nets.h"
#include "render/trace/change_cones.h"
#include "render/trace/sample_pass.h"

namespace inlay {

/// Directions per camera ray that look for a change.
struct ChangeCounts {
    int light = 0;  // drawn from the environment
    int cones = 1;  // drawn evenly over the cones in which virtual geometry can be seen, at most:
                    // where the cones are small, so is the change, and fewer do
};

/// settings.secondary over the cones, and settings.light_tries times as many from the environment,
/// if it sends light.
ChangeCounts change_counts(const TwoModeScene& scene, const SamplingSettings& settings);

/// The samples of one camera ray of 16 pixels: `ray` counts those of the pixel before it.
struct ChangePass {
    SamplePass& pass;
    ChangeCounts counts;
    int ray = 0;
};

/// Samples of E_RV - E_R on real surfaces. A direction in which a virtual surface is nearest takes
/// away the environment's light, or that of the real surface behind, and sends its own. Direct
/// light takes both kinds of directions, each weighted by the density of both together (balance
/// heuristic, Veach 1997), indirect light half of those over the cones. A direction outside all
/// cones changes nothing and is not traced; real geometry is asked only where a ray meets virtual
/// geometry.
void add_change(const ChangePass& change);

}  // namespace inlay
