// Methods: what turns noisy irradiances into a picture's light, one row each.
#pragma once

#include "render/filter/environment_irradiance.h"
#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"
#include "render/trace/two_mode_sampler.h"

#include <string>
#include <vector>

namespace inlay {

/// What every method gets: the same samples as all of its estimator.
struct MethodInput {
    const NoisyLayers& now;
    const NoisyLayers* previous = nullptr;  // null: without the previous frame
    double environment_bandwidth = 0;       // B_e, 1/rad
    const FilterSettings& settings;
    const EnvironmentIrradiance& open_sky;  // what an unoccluded surface receives
    double width = 0;                       // one of the method's widths; 0 where it has none
};

struct Method {
    std::string name;            // as in --only and accuracy.json
    std::string title;           // as a reader sees it
    std::string family;          // none, inlay, thesis or baseline
    std::string summary;         // one sentence
    std::vector<double> widths;  // tried, of which the best one stands for the method; empty: none
    Layers (*apply)(const MethodInput& input);
    bool needs_unshadowed = false;              // the samples without their shadows, too
    Estimator estimator = Estimator::two_mode;  // that takes its samples
};

/// The row that stands for the program's default settings.
inline constexpr const char* default_method = "difference";

/// All methods; a new technique is one row here.
const std::vector<Method>& methods();

/// Throws Error (usage) that names the nearest method.
const Method& method_named(const std::string& name);

}  // namespace inlay
