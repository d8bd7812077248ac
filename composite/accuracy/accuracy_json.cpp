#include "composite/accuracy/accuracy_json.h"

#include <nlohmann/json.hpp>

#include <cmath>

namespace inlay {
namespace {

using nlohmann::ordered_json;

/// JSON has no infinity: a figure that is not finite does not exist.
ordered_json number(double value) {
    return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json number(const std::optional<double>& value) {
    return value ? number(*value) : ordered_json();
}

ordered_json json_of(const Spread& s) {
    return {{"median", s.median}, {"min", s.min}, {"max", s.max}};
}

ordered_json json_of(const StageSpreads& s) {
    return {{"slam", json_of(s.slam)},
            {"trace", json_of(s.trace)},
            {"filter", json_of(s.filter)},
            {"composite", json_of(s.composite)},
            {"total", json_of(s.total)}};
}

ordered_json json_of(const RayCounts& r) {
    return {{"primary", r.primary},
            {"virtual_shadow", r.virtual_shadow},
            {"virtual_indirect", r.virtual_indirect},
            {"real_shadow", r.real_shadow},
            {"real_indirect", r.real_indirect}};
}

ordered_json json_of(const std::optional<CellError>& e) {
    if (!e) return {};
    return {{"rmse", number(e->rmse)},
            {"rmse_influenced", number(e->rmse_influenced)},
            {"relative_rmse", number(e->relative_rmse)},
            {"psnr", number(e->psnr)},
            {"ssim", number(e->ssim)},
            {"flip", number(e->flip)}};
}

ordered_json json_of(const CellFrame& f) {
    return {{"frame", f.frame},
            {"rmse_influenced", number(f.rmse_influenced)},
            {"truth_rmse_influenced", number(f.truth_rmse_influenced)},
            {"psnr", number(f.psnr)},
            {"flip", number(f.flip)},
            {"ms", f.ms}};
}

template <class Item>
ordered_json list_of(const std::vector<Item>& items, ordered_json (*item_json)(const Item&)) {
    ordered_json list = ordered_json::array();
    for (const Item& item : items)
        list.push_back(item_json(item));
    return list;
}

ordered_json json_of(const FailedRepeat& f) {
    return {{"repeat", f.repeat}, {"message", f.message}};
}

ordered_json json_of(const Cell& c) {
    ordered_json json{{"id", c.id},
                      {"knob", c.knob},
                      {"value", c.value},
                      {"method", c.method},
                      {"temporal", c.temporal},
                      {"width", number(c.width)},
                      {"samples", c.primary * c.secondary},
                      {"primary", c.primary},
                      {"secondary", c.secondary}};
    const bool failed = !c.failed.empty();
    json["wall_ms"] = failed ? ordered_json() : json_of(c.wall);
    json["cpu_ms"] = failed ? ordered_json() : json_of(c.cpu);
    json["rays"] = failed ? ordered_json() : json_of(c.rays);
    json["peak_mb"] = failed ? ordered_json() : number(c.peak_mb);
    json["converged"] = json_of(c.converged);
    json["truth"] = json_of(c.truth);
    json["flicker"] = number(c.flicker);
    json["frames"] = list_of(c.frames, json_of);
    json["failed_repeats"] = list_of(c.failed_repeats, json_of);
    json["failed"] = failed ? ordered_json(c.failed) : ordered_json();
    return json;
}

ordered_json json_of(const EqualError& e) {
    return {{"method", e.method},
            {"temporal", e.temporal},
            {"anchor", e.anchor},
            {"error", number(e.error)},
            {"unfiltered_ms", number(e.unfiltered_ms)},
            {"filtered_ms", number(e.filtered_ms)},
            {"speed_up", number(e.speed_up)},
            {"unfiltered_samples", number(e.unfiltered_samples)},
            {"flip_ratio", number(e.flip_ratio)},
            {"beyond", e.beyond}};
}

ordered_json json_of(const EqualTime& e) {
    return {{"method", e.method},
            {"temporal", e.temporal},
            {"ms", number(e.ms)},
            {"rmse", number(e.rmse)},
            {"flip", number(e.flip)},
            {"rmse_ratio", number(e.rmse_ratio)},
            {"flip_ratio", number(e.flip_ratio)},
            {"beyond", e.beyond}};
}

ordered_json json_of(const ReportPicture& p) {
    return {{"cell", p.cell}, {"title", p.title}, {"frame", p.frame}, {"png", p.png}};
}

ordered_json blame_json(const std::vector<FrameBlame>& frames) {
    if (frames.empty()) return {};
    ordered_json list = ordered_json::array();
    for (const FrameBlame& blame : frames) {
        for (const StageBlame& stage : blame.stages)
            list.push_back({{"frame", blame.frame},
                            {"stage", name_of(stage.stage)},
                            {"swapped_rmse", number(stage.swapped_rmse)},
                            {"rmse", number(blame.rmse)},
                            {"best_rmse", number(blame.best_rmse)},
                            {"photograph_rmse", number(blame.photograph_rmse)},
                            {"share", number(stage.share)}});
    }
    return list;
}

ordered_json json_of(const BudgetedFigure& figure) {
    return {{"figure", figure.name},
            {"value", number(figure.value)},
            {"allowed", number(figure.allowed)}};
}

ordered_json json_of(const FrameVerdict& v) {
    const FrameBudget& b = v.budget;
    return {{"frame", v.frame},
            {"kept", keeps_budget(v)},
            {"figures", list_of(figures_of(v), json_of)},
            {"photograph_rmse", number(v.photograph_rmse)},
            {"compared", number(v.light.compared)},
            {"parts",
             {{"equation", number(b.equation)},
              {"room_as_seen", number(b.seen)},
              {"sampling", number(b.sampling)},
              {"displacement", number(b.displacement)},
              {"displaced_px", number(b.displaced_px)},
              {"largest_displaced_px", number(b.bounds.displaced_px)}}}};
}

/// Null where there is none.
ordered_json budget_json(const std::vector<FrameVerdict>& verdicts) {
    return verdicts.empty() ? ordered_json() : list_of(verdicts, json_of);
}

ordered_json json_of(const WorkBlame& work) {
    return {{"name", work.work}, {"blame", blame_json(work.frames)}};
}

ordered_json estimate_json(const std::optional<EstimateQuality>& quality) {
    if (!quality) return {};
    ordered_json frames = ordered_json::array();
    for (const EstimatedFrame& f : quality->frames)
        frames.push_back({{"frame", f.frame},
                          {"estimated_rmse", number(f.estimated_rmse)},
                          {"true_rmse", number(f.true_rmse)}});
    return {{"rank_correlation", number(quality->rank_correlation)},
            {"calibration", number(quality->calibration)},
            {"frames", frames}};
}

ordered_json json_of(const WorkReport& w) {
    const PriceList prices = price_list(w.cells);
    return {{"name", w.name},
            {"title", w.name},
            {"kind", w.kind},
            {"width", w.width},
            {"height", w.height},
            {"frames", w.frames},
            {"environment_bandwidth", number(w.environment_bandwidth)},
            {"reference",
             {{"converged_samples", w.converged_samples},
              {"converged_standard_error", number(w.converged_standard_error)},
              {"truth_samples", w.truth_samples},
              {"truth_standard_error", number(w.truth_standard_error)}}},
            {"cells", list_of(w.cells, json_of)},
            {"fronts", {{"rmse", prices.rmse_front}, {"flip", prices.flip_front}}},
            {"equal_error", list_of(prices.equal_error, json_of)},
            {"equal_time", list_of(prices.equal_time, json_of)},
            {"pictures", list_of(w.pictures, json_of)},
            {"blame", blame_json(w.blame)},
            {"budget", budget_json(w.verdicts)},
            {"estimate", estimate_json(w.estimate)}};
}

ordered_json json_of(const Method& m) {
    return {{"name", m.name}, {"title", m.title}, {"family", m.family}, {"summary", m.summary}};
}

}  // namespace

std::string to_json_text(const AccuracyReport& report) {
    ordered_json settings;
    for (const SettingRow& row : setting_rows())
        settings[row.name] = row.get(report.settings);
    const ordered_json json{{"version", 1},
                            {"kind", "accuracy"},
                            {"program", report.program},
                            {"date", report.date},
                            {"machine", ordered_json::parse(to_json_text(report.machine))},
                            {"settings", settings},
                            {"repeats", report.repeats},
                            {"seed", report.seed},
                            {"quick", report.quick},
                            {"methods", list_of(methods(), json_of)},
                            {"works", list_of(report.works, json_of)}};
    return json.dump(1) + "\n";
}

std::string to_json_text(const std::vector<WorkBlame>& works) {
    const ordered_json json{{"version", 1}, {"kind", "blame"}, {"works", list_of(works, json_of)}};
    return json.dump(1) + "\n";
}

}  // namespace inlay
