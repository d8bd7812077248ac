// The difference form of the light on real surfaces: E_RV - E_R is an integral over the directions
// in which virtual geometry is nearest, and over nothing else.
#pragma once

#include "render/trace/tile_pass.h"

#include <span>

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

/// Samples of E_RV - E_R on real surfaces. A direction in which a virtual surface is nearest takes
/// away the environment's light, or that of the real surface behind, and sends its own. Direct
/// light takes both kinds of directions, each weighted by the density of both together (balance
/// heuristic, Veach 1997), indirect light half of those over the cones. A direction outside all
/// cones changes nothing and is not traced; real geometry is asked only where a ray meets virtual
/// geometry.
///
/// `camera_rays` are where rays of a tile's pixels landed, at least one of each, of which
/// `first_ray` is the number of the first.
void add_changes(const TilePass& tile, std::span<const Landings> camera_rays, int first_ray);

}  // namespace inlay
