#include "composite/accuracy/frame_verdict.h"

#include "composite/blend/differential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

/// Of the second picture of a still camera; the first is the one that is judged.
constexpr std::uint32_t still_seed = 0x5717;

double influenced_rmse(const Reference& truth, const Image<Rgb>& picture) {
    const double square = radiance_error(picture, truth.linear, truth.influenced).rmse;
    return std::sqrt(std::max(0.0, square * square - influenced_variance(truth)));
}

}  // namespace

std::optional<FrameVerdict> judge_frame(const Work& work, const TrackedFrame& frame,
                                        const Settings& settings, int converged_samples) {
    const auto truth = truth_of_frame(work, frame.frame, frame.lens);
    if (truth && std::all_of(truth->influenced.pixels.begin(), truth->influenced.pixels.end(),
                             [](auto counted) { return counted == 0; }))
        return std::nullopt;
    FrameVerdict verdict;
    verdict.frame = frame.frame;
    const ConvergedLight wanted =
        converged_light(work, true_frame(work, frame), settings, converged_samples);
    verdict.budget = frame_budget(work, frame, settings, wanted, converged_samples);
    const Layers layers = light_of(work, frame, settings);
    const Image<Rgb> picture = composite(*frame.photo, layers, settings.blend).linear;
    verdict.rmse = influenced_rmse(*truth, picture);
    verdict.photograph_rmse = influenced_rmse(*truth, frame.photo->linear);
    verdict.light = irradiance_error({layers, layers}, wanted.pair());
    const Layers again = light_of(work, frame, settings, still_seed);
    verdict.flicker = radiance_error(composite(*frame.photo, again, settings.blend).linear, picture,
                                     truth->influenced)
                          .rmse;
    return verdict;
}

std::vector<BudgetedFigure> figures_of(const FrameVerdict& v) {
    return {{"RMSE", v.rmse, v.budget.total},
            {"E_R", v.light.e_r, v.budget.e_r},
            {"E_RV", v.light.e_rv, v.budget.e_rv},
            {"flicker", v.flicker, v.budget.flicker}};
}

bool keeps_budget(const FrameVerdict& verdict) {
    const auto figures = figures_of(verdict);
    return std::all_of(figures.begin(), figures.end(),
                       [](const BudgetedFigure& figure) { return figure.kept(); });
}

std::string verdict_line(const FrameVerdict& verdict) {
    std::string line = fmt::format("frame {}:", verdict.frame), over;
    const char* before = " ";
    for (const BudgetedFigure& figure : figures_of(verdict)) {
        line +=
            fmt::format("{}{} {:.4f} of {:.4f}", before, figure.name, figure.value, figure.allowed);
        before = ", ";
        if (!figure.kept()) over += (over.empty() ? "" : ", ") + figure.name;
    }
    return line + (over.empty() ? "; within its budget" : "; over its budget: " + over);
}

}  // namespace inlay
