#include "composite/plan/effect_rules.h"

#include "composite/plan/effect_costs.h"

#include <fmt/format.h>

namespace inlay {
namespace {

const char* lost = "the camera's pose is not known";
const char* empty = "the scene has no virtual object";

std::string objects_text(int count) {
    return fmt::format("{} virtual object{}", count, count == 1 ? "" : "s");
}

/// What keeps a frame from being simulated at all; empty: nothing does.
std::string hindrance(const SceneFacts& facts) {
    if (!facts.tracked) return lost;
    if (facts.objects.empty()) return empty;
    if (!out_of_reach(facts)) return "";
    const int all = int(facts.objects.size());
    return fmt::format(
        "{} out of view change{} the light on what is seen by at most {:.2g} of its mean; less "
        "than "
        "{:.2g} moves no byte of a surface that gets {:.2g} of it or more",
        objects_text(all), all == 1 ? "s" : "", light_change(facts), unseen_change, least_light);
}

Verdict decide_direct(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    if (!in.facts.lit) return {false, "the environment sends no light"};
    return {true, objects_text(int(in.facts.objects.size())) + " in the environment's light"};
}

Verdict decide_indirect(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    const int all = int(in.facts.objects.size());
    if (objects_in_view(in.facts) > 0)
        return {true, objects_text(all) + " and real surfaces light each other"};
    return {true, objects_text(all) +
                      " out of view, but that no light or shadow from there reaches what is seen "
                      "is not proven"};
}

const ObjectFacts& largest_in_view(const SceneFacts& facts) {
    const ObjectFacts* largest = &facts.objects.front();
    for (const ObjectFacts& o : facts.objects)
        if (o.in_view &&
            (!largest->in_view || o.cover.share_of_view > largest->cover.share_of_view))
            largest = &o;
    return *largest;
}

Verdict decide_virtual_surfaces(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    const int seen = objects_in_view(in.facts), all = int(in.facts.objects.size());
    if (seen == 0) return {false, fmt::format("none of {} is in view", objects_text(all))};
    const ObjectFacts& largest = largest_in_view(in.facts);
    return {true,
            fmt::format("{} of {} may be in view, the largest ({}) on up to {:.2g} % of it", seen,
                        objects_text(all), largest.name, 100 * largest.cover.share_of_view)};
}

Verdict decide_glossy(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    const int seen = glossy_objects_in_view(in.facts), all = glossy_objects(in.facts);
    if (all == 0) return {false, "no virtual object is glossy"};
    if (seen == 0) return {false, fmt::format("no glossy object is in view ({} out of view)", all)};
    return {true, fmt::format("{} of {} may be in view and glossy", seen,
                              objects_text(int(in.facts.objects.size())))};
}

Verdict decide_glossy_at_hits(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    const int all = glossy_objects(in.facts);
    if (all == 0) return {false, "no virtual object is glossy"};
    if (!in.facts.lit) return {false, "the environment sends no light"};
    return {true,
            fmt::format("indirect rays may meet {} glossy object{}", all, all == 1 ? "" : "s")};
}

Verdict decide_filter(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    if (!in.filter.enabled) return {false, "filter.enabled is off"};
    return {true, "irradiances are noisy"};
}

Verdict decide_temporal(const PlanInput& in) {
    const std::string none = hindrance(in.facts);
    if (!none.empty()) return {false, none};
    if (!in.filter.enabled) return {false, "filter.enabled is off"};
    if (!in.filter.temporal) return {false, "filter.temporal is off"};
    if (in.facts.first_frame) return {false, "there is no frame before"};
    if (in.facts.moving) return {false, "a virtual object has moved since the frame before"};
    return {true, "the frame before is at hand, and nothing virtual has moved since"};
}

/// The verdict of an effect that scenes ask for by a count.
Verdict asked_for(int count, const char* one, const char* many) {
    if (count == 0) return {false, std::string("the scene has no ") + one};
    return {true, fmt::format("the scene has {} {}", count, count == 1 ? one : many)};
}

const std::vector<EffectRule> rules{
    {"environment_direct", "soft shadows of the environment, on and from virtual objects",
     decide_direct, cost_of_direct},
    {"environment_indirect", "color and light that surfaces send each other", decide_indirect,
     cost_of_indirect},
    {"virtual_surfaces", "the virtual objects themselves: their edges, textures and shading",
     decide_virtual_surfaces, cost_of_virtual_surfaces},
    {"glossy", "highlights and reflections on objects that are seen", decide_glossy,
     cost_of_glossy},
    {"glossy_at_hits", "highlights that reach other surfaces", decide_glossy_at_hits,
     [](const PlanInput&) { return EffectCost{}; }},  // the rays are those of environment_indirect
    {"axis_aligned_filter", "smooth irradiance from few samples", decide_filter, cost_of_filter},
    {"temporal_filter", "twice the samples for the filter, and less flicker", decide_temporal,
     cost_of_temporal},
    {"polygon_light", "light of shining polygons",
     [](const PlanInput& in) {
         return asked_for(in.facts.requests.polygon_lights, "polygon light", "polygon lights");
     },
     nullptr},
    {"mesh_light", "light of shining meshes",
     [](const PlanInput& in) {
         return asked_for(in.facts.requests.mesh_lights, "shining mesh", "shining meshes");
     },
     nullptr},
    {"medium", "haze and smoke",
     [](const PlanInput& in) {
         return Verdict{in.facts.requests.medium, in.facts.requests.medium
                                                      ? "the scene has a medium"
                                                      : "the scene has no medium"};
     },
     nullptr},
    {"hair", "fibres and their scattering",
     [](const PlanInput&) {
         return Verdict{false, "no object has strands"};
     },
     nullptr},
    {"defocus", "blur out of focus",
     [](const PlanInput& in) {
         const double radius = in.facts.requests.aperture_radius;
         if (radius == 0) return Verdict{false, "the aperture is a pinhole"};
         return Verdict{true, fmt::format("the aperture has a radius of {} m", radius)};
     },
     nullptr},
    {"motion_blur", "blur of what moves",
     [](const PlanInput& in) {
         const double shutter = in.facts.requests.shutter;
         if (shutter == 0) return Verdict{false, "the shutter is open for no time"};
         return Verdict{true, fmt::format("the shutter is open for {} s", shutter)};
     },
     nullptr},
    {"precomputed_transfer", "light of still objects, made ahead",
     [](const PlanInput&) {
         return Verdict{false, "no object comes with a transfer table"};
     },
     nullptr},
    {"light_field", "light that has been seen before, kept in space",
     [](const PlanInput&) {
         return Verdict{false, "no light field is at hand"};
     },
     nullptr}};

}  // namespace

const std::vector<EffectRule>& effect_rules() { return rules; }

}  // namespace inlay
