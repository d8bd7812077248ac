// A plan as text for --explain, and as JSON for run.json.
#pragma once

#include "composite/plan/effect_plan.h"

#include <string>

namespace inlay {

/// The facts, then every effect: in or out, the fact that decided, what it costs and is worth; then
/// the passes with their samples.
std::string explain(const EffectPlan& plan);

/// A list with one entry per effect, of the form in apps/report/README.md.
std::string to_json_text(const EffectPlan& plan);

}  // namespace inlay
