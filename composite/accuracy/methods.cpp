#include "composite/accuracy/methods.h"

#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"
#include "render/filter/filter_layers.h"

namespace inlay {
namespace {

Layers unfiltered(const MethodInput& in) {
    FilterSettings settings = in.settings;
    settings.enabled = false;
    return filter_layers(in.now, nullptr, in.environment_bandwidth, settings);
}

Layers axis_aligned(const MethodInput& in) {
    return filter_layers(in.now, in.previous, in.environment_bandwidth, in.settings);
}

template <FilterConstants constants>
Layers axis_aligned_with(const MethodInput& in) {
    FilterSettings settings = in.settings;
    settings.constants = constants;
    return filter_layers(in.now, in.previous, in.environment_bandwidth, settings);
}

}  // namespace

const std::vector<Method>& methods() {
    static const std::vector<Method> rows{
        {"unfiltered", "Unfiltered", "none", "The samples as they are.", {}, unfiltered},
        {"axis_aligned",
         "Axis-aligned filter",
         "inlay",
         "Widths from the light's bandwidth, two safety factors (the program's default).",
         {},
         axis_aligned},
        {"thesis",
         "Axis-aligned filter, as printed",
         "thesis",
         "The constants and widths of Mehta 2015, chapter 6.",
         {},
         axis_aligned_with<FilterConstants::thesis>},
    };
    return rows;
}

const Method& method_named(const std::string& name) {
    std::vector<std::string> names;
    for (const Method& method : methods()) {
        if (method.name == name) return method;
        names.push_back(method.name);
    }
    throw Error(ExitCode::usage, "there is no method '" + name + "'; did you mean '" +
                                     nearest_word(name, names) + "'?");
}

}  // namespace inlay
