// EffectPlan: which effects a frame calls for, decided from facts about scene and settings, with
// what each costs.
#pragma once

#include "composite/plan/scene_facts.h"
#include "render/filter/filter_settings.h"
#include "render/trace/two_mode_sampler.h"

#include <string>
#include <vector>

namespace inlay {

/// Rays of each class per pixel of the image.
struct RaysPerPixel {
    double primary = 0, virtual_shadow = 0, virtual_indirect = 0, real_shadow = 0,
           real_indirect = 0;
};

RaysPerPixel operator+(const RaysPerPixel& a, const RaysPerPixel& b);

/// One run over the pixels that an effect makes necessary.
struct PlannedPass {
    std::string name;
    double samples_per_pixel = 0;  // where it runs
    double share_of_pixels = 1;    // where it runs, at most
};

struct EffectCost {
    std::vector<PlannedPass> passes;
    RaysPerPixel rays;          // at most: as if every ray met something and nothing were skipped
    double taps_per_pixel = 0;  // of the filter's kernels
};

struct PlannedEffect {
    std::string name;
    bool in = false;
    bool built = true;   // whether this version can simulate it
    bool asked = false;  // the scene asks for what is not built
    std::string reason;  // the fact that decided
    std::string worth;   // what is lost without it
    EffectCost cost{};   // of one that is in
};

struct EffectPlan {
    SceneFacts facts;
    std::vector<PlannedEffect> effects;
    bool has(const std::string& name) const;
    std::vector<std::string> names() const;  // of those that are in
    RaysPerPixel rays() const;               // of those together
};

/// Decides every effect of the table in effect_rules.cpp.
EffectPlan plan_effects(const SceneFacts& facts, const SamplingSettings& sampling,
                        const FilterSettings& filter);

}  // namespace inlay
