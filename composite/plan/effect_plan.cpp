#include "composite/plan/effect_plan.h"

#include "composite/plan/effect_rules.h"

#include <algorithm>

namespace inlay {

RaysPerPixel operator+(const RaysPerPixel& a, const RaysPerPixel& b) {
    return {a.primary + b.primary, a.virtual_shadow + b.virtual_shadow,
            a.virtual_indirect + b.virtual_indirect, a.real_shadow + b.real_shadow,
            a.real_indirect + b.real_indirect};
}

bool EffectPlan::has(const std::string& name) const {
    return std::any_of(effects.begin(), effects.end(),
                       [&](const PlannedEffect& e) { return e.in && e.name == name; });
}

std::vector<std::string> EffectPlan::names() const {
    std::vector<std::string> result;
    for (const PlannedEffect& e : effects)
        if (e.in) result.push_back(e.name);
    return result;
}

RaysPerPixel EffectPlan::rays() const {
    RaysPerPixel sum;
    for (const PlannedEffect& e : effects)
        sum = sum + e.cost.rays;
    return sum;
}

EffectPlan plan_effects(const SceneFacts& facts, const SamplingSettings& sampling,
                        const FilterSettings& filter) {
    EffectPlan plan{facts, {}};
    const PlanInput input{facts, sampling, filter};
    for (const EffectRule& rule : effect_rules()) {
        PlannedEffect effect{rule.name, false, rule.cost != nullptr, false, {}, rule.worth};
        const Verdict verdict = rule.decide(input);
        effect.reason = verdict.reason;
        effect.in = verdict.called_for && effect.built;
        effect.asked = verdict.called_for && !effect.built;
        if (effect.in) effect.cost = rule.cost(input);
        plan.effects.push_back(std::move(effect));
    }
    return plan;
}

}  // namespace inlay
