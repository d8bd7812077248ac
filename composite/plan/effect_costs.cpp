#include "composite/plan/effect_costs.h"

#include "render/trace/real_light.h"

#include <algorithm>

namespace inlay {
namespace {

double light_samples(const SamplingSettings& s) { return double(s.primary) * s.secondary; }

/// Per camera ray: half of the directions over the cones, at most.
double half_of_cones(const SamplingSettings& s) { return (s.secondary + 1) / 2; }

template <class Test>
double share(const SceneFacts& facts, double ObjectInView::*kind, const Test& test) {
    double sum = 0;
    for (const ObjectFacts& o : facts.objects)
        if (o.in_view && test(o)) sum += o.cover.*kind;
    return std::min(1.0, sum);
}

double seen_share(const SceneFacts& facts, double ObjectInView::*kind) {
    return share(facts, kind, [](const ObjectFacts&) { return true; });
}

/// Rays of `samples` indirect ones per pixel: each meets a virtual surface at most, where one light
/// sample needs a shadow ray against both kinds of geometry.
RaysPerPixel indirect_rays(const PlanInput& input, double samples) {
    const double at_hits = input.facts.lit ? samples : 0;
    return {0, at_hits, samples, at_hits, samples};
}

/// Camera rays per pixel where virtual surfaces are in view, beyond those that every pixel takes.
int further_looks(const SamplingSettings& s) {
    return std::max({0, s.coverage - s.primary, s.primary * (s.virtual_repeats - 1)});
}

/// Samples on virtual surfaces beyond those that every pixel takes: repeats where they are seen,
/// and a block more of each kind of surface that only coverage rays meet.
double further_samples(const SamplingSettings& s, double covered, double with_rim) {
    const double repeats = light_samples(s) * (s.virtual_repeats - 1) * covered;
    return repeats +
           (further_looks(s) > 0 ? double(s.secondary) * (s.virtual_repeats + 1) * with_rim : 0);
}

}  // namespace

EffectCost cost_of_direct(const PlanInput& input) {
    const SamplingSettings& s = input.sampling;
    const double samples = light_samples(s);
    if (s.estimator == Estimator::two_mode)
        return {{{"direct light", samples, 1}}, {0, samples, 0, samples, 0}};
    const double tries = s.light_tries * samples + s.primary * half_of_cones(s);
    const double real = most_real_light_samples(s);
    return {{{"directions tried for a change", tries, 1}, {"real direct light", real, 1}},
            {0, tries, 0, tries + real, 0}};
}

EffectCost cost_of_indirect(const PlanInput& input) {
    const SamplingSettings& s = input.sampling;
    const double samples = light_samples(s);
    EffectCost cost{{{"camera rays", double(s.primary), 1}, {"indirect light", samples, 1}},
                    indirect_rays(input, samples)};
    cost.rays.primary = s.primary;
    if (s.estimator == Estimator::two_mode) return cost;
    const double real = most_real_light_samples(s);
    const double tries = s.primary * half_of_cones(s);
    cost.rays.primary *= 2;  // once more for E_R, from where they land
    cost.passes = {{"camera rays", double(s.primary), 1},
                   {"directions tried for an exchange", tries, 1},
                   {"real indirect light", real, 1}};
    cost.rays.real_indirect = std::max(samples, tries + real);  // on virtual surfaces, on real ones
    return cost;
}

EffectCost cost_of_virtual_surfaces(const PlanInput& input) {
    const SamplingSettings& s = input.sampling;
    const double covered = seen_share(input.facts, &ObjectInView::share_of_view);
    const double with_rim = seen_share(input.facts, &ObjectInView::share_with_rim);
    const double coverage = further_looks(s);
    const double further = further_samples(s, with_rim, with_rim);
    EffectCost cost{{}, indirect_rays(input, further)};
    cost.rays.primary = coverage * with_rim;
    if (input.facts.lit) {
        cost.rays.virtual_shadow += further;
        cost.rays.real_shadow += further;
    }
    if (coverage > 0) cost.passes.push_back({"coverage rays", coverage, with_rim});
    if (s.virtual_repeats > 1)
        cost.passes.push_back({"light again", light_samples(s) * (s.virtual_repeats - 1), covered});
    return cost;
}

EffectCost cost_of_glossy(const PlanInput& input) {
    const SamplingSettings& s = input.sampling;
    const auto glossy = [](const ObjectFacts& o) { return o.glossy; };
    const double covered = share(input.facts, &ObjectInView::share_of_view, glossy);
    const double with_rim = share(input.facts, &ObjectInView::share_with_rim, glossy);
    const double most = light_samples(s) * with_rim + further_samples(s, with_rim, with_rim);
    return {{{"glossy lobes", light_samples(s) * s.virtual_repeats, covered}},
            indirect_rays(input, most)};
}

EffectCost cost_of_filter(const PlanInput& input) {
    const bool seen = objects_in_view(input.facts) > 0,
               glossy = glossy_objects_in_view(input.facts) > 0;
    const int layers = 2 * (seen ? 3 : 2) + (glossy ? 1 : 0);  // direct and indirect: E_R, E_RV
    const double taps = 2.0 * (2 * input.filter.kernel_radius + 1);  // along a row and a column
    return {{{"smoothing of layers", double(layers), 1}}, {}, layers * taps};
}

EffectCost cost_of_temporal(const PlanInput& input) {
    const int layers = 2 * (objects_in_view(input.facts) > 0 ? 3 : 2);
    const double taps = 2.0 * (2 * input.filter.kernel_radius + 1);
    return {{{"smoothing of the frame before", double(layers), 1}}, {}, layers * taps};
}

}  // namespace inlay
