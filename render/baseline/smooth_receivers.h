// What every baseline shares: each kind of receiver is smoothed alone, by a function over planes.
#pragma once

#include "render/filter/axis_aligned_filter.h"
#include "render/trace/layers.h"

#include <functional>

namespace inlay {

/// Replaces planes.channels by smoothed ones of the same size, all with the same weights; what it
/// leaves where there is no object does not matter. The channels are red, green and blue of each
/// image: E_R and E_RV_real on real receivers, E_RV_virtual on virtual ones. Precisions are empty.
using Smoother = std::function<void(FilterPlanes& planes)>;

/// What a smoother wants to be handed.
struct SmootherNeeds {
    bool lights_apart =
        false;            // direct and indirect light in calls of their own, since the weights
                          // depend on the light; else all in one call, direct light first
    bool surface = true;  // positions and normals; else planes.surface is null
};

/// `now` with its irradiances smoothed; M and k_V unchanged, S_RV too but for values that are not
/// finite, which become 0. Pixels without a receiver of the kind, or with a value that is not
/// finite, are 0 and are not handed to the smoother as pixels with an object. Planes are cut to the
/// rectangle that holds receivers. Bandwidths are 0: baselines know none. Throws Error when the
/// sizes of `now` do not match.
Layers smooth_receivers(const NoisyLayers& now, const SmootherNeeds& needs,
                        const Smoother& smoother);

/// Throws Error(usage) that names the setting unless `value` is finite and above 0.
void require_width(double value, const char* name);

}  // namespace inlay
