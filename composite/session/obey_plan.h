// Work that a plan may leave out of a frame.
#pragma once

#include "composite/plan/effect_plan.h"
#include "render/sample/environment_sampler.h"
#include "render/trace/layers.h"
#include "render/trace/two_mode_sampler.h"

namespace inlay {

/// A sampler for light that is not there: black, and without a sample to trace a shadow ray for.
EnvironmentSampler no_light();

/// The settings without the work on surfaces that the plan says no camera ray can meet.
SamplingSettings planned_sampling(const EffectPlan& plan, SamplingSettings settings);

/// What a frame's layers are made of. Null: nothing was simulated, or there is no frame before.
struct SampledFrames {
    const NoisyLayers* now = nullptr;
    const NoisyLayers* before = nullptr;
};

/// The layers to composite: smoothed if the plan has the filter, else the samples' means as they
/// are; where nothing was simulated, layers that leave `photo` as it is. `environment_bandwidth` is
/// asked for only by the filter.
Layers planned_layers(const EffectPlan& plan, const SampledFrames& frames, const Image<Rgb>& photo,
                      double environment_bandwidth, const FilterSettings& settings);

}  // namespace inlay
