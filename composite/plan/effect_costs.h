// What the effects that are built cost, as upper bounds from settings and facts. For the sources of
// this folder only.
#pragma once

#include "composite/plan/effect_rules.h"

namespace inlay {

EffectCost cost_of_direct(const PlanInput& input);
EffectCost cost_of_indirect(const PlanInput& input);
EffectCost cost_of_virtual_surfaces(const PlanInput& input);
EffectCost cost_of_glossy(const PlanInput& input);
EffectCost cost_of_filter(const PlanInput& input);
EffectCost cost_of_temporal(const PlanInput& input);

}  // namespace inlay
