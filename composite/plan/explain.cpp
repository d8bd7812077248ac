#include "composite/plan/explain.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <utility>

namespace inlay {
namespace {

using RayClass = std::pair<const char*, double>;

std::array<RayClass, 5> classes_of(const RaysPerPixel& r) {
    return {RayClass{"primary", r.primary}, RayClass{"virtual_shadow", r.virtual_shadow},
            RayClass{"virtual_indirect", r.virtual_indirect},
            RayClass{"real_shadow", r.real_shadow}, RayClass{"real_indirect", r.real_indirect}};
}

std::string rays_text(const RaysPerPixel& rays) {
    std::string text;
    for (const auto& [name, count] : classes_of(rays))
        if (count > 0) text += fmt::format("{}{:.3g} {}", text.empty() ? "" : ", ", count, name);
    return text.empty() ? "no ray" : "at most " + text;
}

std::string cost_text(const EffectCost& cost) {
    std::string text = rays_text(cost.rays);
    if (cost.taps_per_pixel > 0) text += fmt::format(", {:.4g} taps", cost.taps_per_pixel);
    return text;
}

std::string size_text(const ObjectInView& cover) {
    if (!std::isfinite(cover.size_px.x + cover.size_px.y)) return "reaches the camera's plane";
    return fmt::format("up to {:.3g} x {:.3g} px", cover.size_px.x, cover.size_px.y);
}

std::string object_text(const ObjectFacts& o) {
    std::string text = "object " + o.name + ": " + (o.glossy ? "glossy" : "diffuse");
    if (o.textured) text += ", textured";
    if (o.in_view) return text + ", may be in view, " + size_text(o.cover) + "\n";
    text += o.cover.possible ? ", too small to be seen, " + size_text(o.cover) : ", out of view";
    if (o.light_change < 1)
        text += fmt::format(", may change up to {:.2g} of the mean light", o.light_change);
    return text + "\n";
}

std::string effect_text(const PlannedEffect& e) {
    std::string text = std::string(e.in ? "in   " : "out  ") + e.name + ": ";
    if (e.asked) text += "not built, so that the scene is refused: ";
    if (!e.built && !e.asked) text += "not built; ";
    text += e.reason + "\n";
    if (e.in) text += "       costs " + cost_text(e.cost) + " per pixel; worth: " + e.worth + "\n";
    return text;
}

std::string pass_text(const PlannedEffect& e, const PlannedPass& pass) {
    return fmt::format("pass {}: {:.3g} per pixel on {}{:.3g} % of the pixels, for {}\n", pass.name,
                       pass.samples_per_pixel, pass.share_of_pixels < 1 ? "up to " : "",
                       100 * pass.share_of_pixels, e.name);
}

}  // namespace

std::string explain(const EffectPlan& plan) {
    const SceneFacts& facts = plan.facts;
    std::string text = fmt::format(
        "{} virtual object{}, {} of which may be in view; environment {}\n", facts.objects.size(),
        facts.objects.size() == 1 ? "" : "s", objects_in_view(facts), facts.lit ? "lit" : "dark");
    for (const ObjectFacts& object : facts.objects)
        text += object_text(object);
    if (facts.light_kept && plan.has("environment_indirect"))
        text +=
            "light on real surfaces alone is kept on the model: what its samples cost below, "
            "frames pay where they are the first to see a surface\n";
    for (const PlannedEffect& e : plan.effects)
        text += effect_text(e);
    for (const PlannedEffect& e : plan.effects)
        for (const PlannedPass& pass : e.cost.passes)
            text += pass_text(e, pass);
    return text + "all together: " + rays_text(plan.rays()) + " per pixel\n";
}

std::string to_json_text(const EffectPlan& plan) {
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const PlannedEffect& e : plan.effects) {
        Json rays = Json::object(), passes = Json::array();
        for (const auto& [name, count] : classes_of(e.cost.rays))
            rays[name] = count;
        for (const PlannedPass& pass : e.cost.passes)
            passes.push_back({{"pass", pass.name},
                              {"samples_per_pixel", pass.samples_per_pixel},
                              {"share_of_pixels", pass.share_of_pixels}});
        list.push_back({{"effect", e.name},
                        {"in", e.in},
                        {"built", e.built},
                        {"reason", e.reason},
                        {"worth", e.worth},
                        {"rays_per_pixel", rays},
                        {"taps_per_pixel", e.cost.taps_per_pixel},
                        {"passes", passes}});
    }
    return list.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace inlay
