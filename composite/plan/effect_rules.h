// The table of effects: when each is called for, what it costs, what it is worth.
#pragma once

#include "composite/plan/effect_plan.h"

#include <string>
#include <vector>

namespace inlay {

struct PlanInput {
    const SceneFacts& facts;
    const SamplingSettings& sampling;
    const FilterSettings& filter;
};

struct Verdict {
    bool called_for = false;
    std::string reason;  // the fact that decided, in words
};

struct EffectRule {
    const char* name;
    const char* worth;
    Verdict (*decide)(const PlanInput&);
    EffectCost (*cost)(const PlanInput&);  // null: no technique for it is built
};

/// In the order in which a frame takes them; those that are not built come last. An effect that is
/// not built is called for by a scene alone, never by settings.
const std::vector<EffectRule>& effect_rules();

}  // namespace inlay
