#include "composite/accuracy/knobs.h"

#include <string>
#include <utility>

namespace inlay {
namespace {

void turn_samples(Sampling& s, const std::string& value) {
    s.settings.trace = with_samples(s.settings.trace, std::stoi(value));
}

/// "8x2": camera rays per pixel x light samples per camera ray.
void turn_split(Sampling& s, const std::string& value) {
    const std::size_t cross = value.find('x');
    s.settings.trace.primary = std::stoi(value.substr(0, cross));
    s.settings.trace.secondary = std::stoi(value.substr(cross + 1));
}

/// A knob that is one of the program's settings.
Knob setting(const std::string& name, std::vector<std::string> values) {
    return {name, std::move(values), [name](Sampling& s, const std::string& value) {
                apply_setting(s.settings, name + "=" + value);
            }};
}

void turn_noise(Sampling& s, const std::string& value) {
    s.depth = value == "exact" ? SensorDepth::exact : SensorDepth::recorded;
}

void turn_light_list(Sampling& s, const std::string& value) {
    s.light_list = value == "tables" ? 0 : std::stoi(value);
}

}  // namespace

std::vector<Knob> knobs(bool quick) {
    Knob samples{"samples", {"1", "4", "16", "64", "256", "1024"}, turn_samples};
    Knob split{"split",
               {"4x4", "1x16", "2x8", "8x2", "16x1", "16x4", "64x1", "64x4", "256x1"},
               turn_split};
    samples.all_methods = true;
    if (quick) {
        samples.values = {"4", "16", "64"};
        split.values = {"4x4", "16x1"};
    }
    Knob geometry = setting("geometry.kind", {"model", "screen", "map"});
    Knob voxel = setting("slam.fusion.voxel_size", {"0.008", "0.005", "0.016"});
    Knob poses = setting("slam.poses", {"tracked", "recorded"});
    Knob noise{"sensor.depth", {"recorded", "exact"}, turn_noise};
    noise.needs_room = true;
    for (Knob* knob : {&geometry, &voxel, &poses, &noise})
        knob->needs_tracking = knob->against_truth = true;
    if (quick) return {samples, split, poses};
    return {samples,
            split,
            setting("filter.curvature_safety", {"0.2", "0.1", "0.4", "0.8"}),
            setting("filter.visibility_safety", {"1", "0.5", "2", "4"}),
            setting("filter.kernel_radius", {"15", "4", "8", "30"}),
            setting("trace.coverage", {"32", "0", "8", "128"}),
            setting("trace.spread", {"on", "off"}),
            setting("trace.gathered", {"64", "0", "16", "256"}),
            {"light_list", {"tables", "256", "1024", "4096", "16384"}, turn_light_list},
            geometry,
            voxel,
            poses,
            noise};
}

}  // namespace inlay
