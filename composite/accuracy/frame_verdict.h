// FrameVerdict: a frame's errors beside the budget that was derived for them before.
#pragma once

#include "composite/accuracy/frame_budget.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

struct FrameVerdict {
    int frame = 0;
    FrameBudget budget;
    double rmse = 0;             // of the composite against truth, over the influenced pixels
    double photograph_rmse = 0;  // of the recorded picture, without any object
    IrradianceError light;       // relative RMSE of E_R and E_RV
    double flicker = 0;          // RMS change of a still camera's filtered picture
};

/// Derives the frame's budget, then composites it under `settings`, without the previous frame, and
/// measures. Nothing where the truth has no influenced pixel. Throws Error as frame_budget().
std::optional<FrameVerdict> judge_frame(const Work& work, const TrackedFrame& frame,
                                        const Settings& settings, int converged_samples);

/// One of the figures that have a budget.
struct BudgetedFigure {
    std::string name;  // RMSE, E_R, E_RV, flicker
    double value = 0, allowed = 0;
    bool kept() const { return value <= allowed; }
};
std::vector<BudgetedFigure> figures_of(const FrameVerdict& verdict);

/// Whether all figures keep their budgets.
bool keeps_budget(const FrameVerdict& verdict);

/// One line: every figure with what is allowed, and which of them is over it.
std::string verdict_line(const FrameVerdict& verdict);

}  // namespace inlay
