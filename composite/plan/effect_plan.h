// EffectPlan: which effects a frame calls for, decided from facts about scene and settings.
#pragma once

#include "render/filter/filter_settings.h"
#include "render/scene/virtual_scene.h"

#include <string>
#include <vector>

namespace inlay {

/// What the rules look at.
struct SceneFacts {
    int objects = 0;           // virtual ones
    bool moving = false;       // one of them has moved since the frame before
    bool lit = false;          // the environment sends light
    bool tracked = true;       // the camera's pose is known
    bool first_frame = false;  // there is no frame before to filter with
};

/// `time` and `time_before` (s) are those of this frame and of the one before it.
SceneFacts gather_facts(const VirtualScene& scene, bool lit, double time, double time_before);

struct PlannedEffect {
    std::string name;
    bool in = false;
    std::string reason;  // the fact that decided
};

struct EffectPlan {
    std::vector<PlannedEffect> effects;
    bool has(const std::string& name) const;
    std::vector<std::string> names() const;  // of those that are in
};

EffectPlan plan_effects(const SceneFacts& facts, const FilterSettings& filter);

/// One line per effect: in or out, and why.
std::string explain(const EffectPlan& plan);

}  // namespace inlay
