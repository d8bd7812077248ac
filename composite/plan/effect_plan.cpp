#include "composite/plan/effect_plan.h"

#include <algorithm>

namespace inlay {
namespace {

struct EffectRule {
    const char* name;
    bool (*in)(const SceneFacts&, const FilterSettings&);
    const char* because_in;
    const char* because_out;
};

bool visible(const SceneFacts& f) { return f.objects > 0 && f.tracked; }

/// A new effect adds a row here, and its work asks EffectPlan::has() for it.
const EffectRule rules[] = {
    {"environment_direct",
     [](const SceneFacts& f, const FilterSettings&) { return visible(f) && f.lit; },
     "virtual objects in light of the environment",
     "no virtual object, no light, or tracking lost"},
    {"environment_indirect", [](const SceneFacts& f, const FilterSettings&) { return visible(f); },
     "virtual and real surfaces light each other", "no virtual object, or tracking lost"},
    {"axis_aligned_filter",
     [](const SceneFacts& f, const FilterSettings& s) { return visible(f) && s.enabled; },
     "irradiances are noisy", "nothing to filter, or --filter off"},
    {"temporal_filter",
     [](const SceneFacts& f, const FilterSettings& s) {
         return visible(f) && s.enabled && s.temporal && !f.first_frame && !f.moving;
     },
     "the frame before is at hand, and nothing virtual has moved since",
     "no frame before, something virtual has moved since, or --temporal off"},
};

}  // namespace

SceneFacts gather_facts(const VirtualScene& scene, bool lit, double time, double time_before) {
    SceneFacts facts;
    facts.lit = lit;
    for (const SceneObject& object : scene.objects) {
        if (object.real) continue;
        ++facts.objects;
        facts.moving =
            facts.moving || transform_at(object, time) != transform_at(object, time_before);
    }
    return facts;
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

EffectPlan plan_effects(const SceneFacts& facts, const FilterSettings& filter) {
    EffectPlan plan;
    for (const EffectRule& rule : rules) {
        const bool in = rule.in(facts, filter);
        plan.effects.push_back({rule.name, in, in ? rule.because_in : rule.because_out});
    }
    return plan;
}

std::string explain(const EffectPlan& plan) {
    std::string text;
    for (const PlannedEffect& e : plan.effects)
        text += std::string(e.in ? "in   " : "out  ") + e.name + ": " + e.reason + "\n";
    return text;
}

}  // namespace inlay
