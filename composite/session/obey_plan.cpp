#include "composite/session/obey_plan.h"

#include "render/filter/filter_layers.h"

namespace inlay {

EnvironmentSampler no_light() {
    EnvironmentSampler sampler = make_environment_sampler({Image<Rgb>(2, 1, Rgb(0))});
    for (double& sum : sampler.rows.cumulative)
        sum = 0;  // no row has a share, so every sample has density 0
    return sampler;
}

SamplingSettings planned_sampling(const EffectPlan& plan, SamplingSettings settings) {
    settings.virtual_seen = plan.has("virtual_surfaces");
    settings.glossy_seen = plan.has("glossy");
    return settings;
}

Layers planned_layers(const EffectPlan& plan, const SampledFrames& frames, const Image<Rgb>& photo,
                      double environment_bandwidth, const FilterSettings& settings) {
    if (!frames.now) {
        Layers layers;
        layers.m = Image<float>(photo.width, photo.height, 1.0f);
        return layers;
    }
    const NoisyLayers& now = *frames.now;
    if (!plan.has("axis_aligned_filter"))
        return {now.m, now.k_v, now.s_rv, now.direct, now.indirect, {}, {}};
    return filter_layers(now, plan.has("temporal_filter") ? frames.before : nullptr,
                         environment_bandwidth, settings);
}

}  // namespace inlay
