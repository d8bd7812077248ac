#include "composite/accuracy/methods.h"

#include "recordings/base/check.h"
#include "recordings/base/nearest_word.h"
#include "render/baseline/a_trous.h"
#include "render/baseline/gaussian_irradiance.h"
#include "render/baseline/gaussian_ratio.h"
#include "render/baseline/guided_filter.h"
#include "render/baseline/joint_bilateral.h"
#include "render/baseline/non_local_means.h"
#include "render/baseline/with_previous.h"
#include "render/filter/filter_layers.h"

#include <type_traits>

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

Layers shadow_ratio(const MethodInput& in) {
    return filter_layers(in.now, in.previous, in.environment_bandwidth, in.settings, &in.open_sky);
}

/// A method that knows one frame only gets both frames' samples as one.
template <auto filter>
Layers baseline(const MethodInput& in) {
    using Width =
        std::conditional_t<std::is_same_v<decltype(filter), Layers (*)(const NoisyLayers&, int)>,
                           int, double>;
    const auto width = Width(in.width);
    if (in.previous == nullptr) return filter(in.now, width);
    return filter(with_previous(in.now, *in.previous, in.settings), width);
}

constexpr auto gaussian =
    +[](const NoisyLayers& now, double sigma) { return gaussian_irradiance(now, sigma); };
constexpr auto ratio =
    +[](const NoisyLayers& now, double sigma) { return gaussian_ratio(now, sigma); };
constexpr auto bilateral =
    +[](const NoisyLayers& now, double sigma) { return joint_bilateral(now, sigma); };
constexpr auto guided =
    +[](const NoisyLayers& now, int radius) { return guided_filter(now, radius); };
constexpr auto non_local =
    +[](const NoisyLayers& now, double strength) { return non_local_means(now, strength); };
constexpr auto wavelet = +[](const NoisyLayers& now, int levels) { return a_trous(now, levels); };

}  // namespace

const std::vector<Method>& methods() {
    static const std::vector<Method> rows{
        {"unfiltered", "Unfiltered", "none", "The samples as they are.", {}, unfiltered},
        {"axis_aligned",
         "Axis-aligned filter",
         "inlay",
         "Widths from the light's bandwidth, two safety factors.",
         {},
         axis_aligned},
        {"difference",
         "Difference form",
         "inlay",
         "Samples what virtual geometry changes, towards it, and filters that change alone (the "
         "program's default).",
         {},
         axis_aligned,
         false,
         Estimator::difference},
        {"thesis",
         "Axis-aligned filter, as printed",
         "thesis",
         "The constants and widths of Mehta 2015, chapter 6.",
         {},
         axis_aligned_with<FilterConstants::thesis>},
        {"durand",
         "Axis-aligned filter, Durand's bandwidth",
         "thesis",
         "Widths from Durand's frequency analysis (Mehta 2015, eq. 6.19).",
         {},
         axis_aligned_with<FilterConstants::durand>},
        {"shadow_ratio",
         "Shadow ratio",
         "inlay",
         "Filters direct light with and without shadows and multiplies their ratio with the exact "
         "open sky.",
         {},
         shadow_ratio,
         true},
        {"gaussian",
         "Gaussian blur",
         "baseline",
         "One width (px) for all irradiances.",
         {1, 2, 4, 8},
         baseline<gaussian>},
        {"gaussian_ratio",
         "Blurred ratio",
         "baseline",
         "A Gaussian (px) on the ratio image, as a compositor's blur node.",
         {1, 2, 4, 8},
         baseline<ratio>},
        {"joint_bilateral",
         "Joint bilateral",
         "baseline",
         "A Gaussian (px) that normals and depth stop.",
         {2, 4, 8},
         baseline<bilateral>},
        {"guided",
         "Guided filter",
         "baseline",
         "Local linear fits to the normals over windows of a radius (px).",
         {2, 4, 8, 16},
         baseline<guided>},
        {"non_local_means",
         "Non-local means",
         "baseline",
         "Averages pixels with like neighborhoods; strength in units of the noise.",
         {0.5, 1, 2},
         baseline<non_local>},
        {"a_trous",
         "A-trous wavelets",
         "baseline",
         "The spatial part of SVGF: levels of a wavelet filter led by variance.",
         {1, 2, 3, 4, 5},
         baseline<wavelet>},
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
