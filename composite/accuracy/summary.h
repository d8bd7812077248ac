// Summary: the figures of a price list that are worth quoting, as text.
#pragma once

#include "composite/accuracy/accuracy_json.h"

#include <optional>
#include <string>
#include <vector>

namespace inlay {

/// How a method's error falls with samples: the slope of log RMSE over log samples through its
/// cells of the knob `samples` (least squares). -0.5 is noise of independent samples alone, 0 bias
/// alone. Nothing where fewer than two of them have an error above 0 over influenced pixels against
/// `converged`.
std::optional<double> error_slope(const std::vector<Cell>& cells, const std::string& method,
                                  bool temporal);

/// Markdown: the head of the table of stages to blame, and its rows.
std::string blame_table_head();
std::string blame_table_row(const std::string& work, const FrameBlame& blame);

/// Markdown: date, machine, and per work the figures at equal error, at equal time, the slopes,
/// the budgets and the blame. Each row names its work, so that it can be quoted by itself; a figure
/// that does not exist is a dash.
std::string summary_text(const AccuracyReport& report);

}  // namespace inlay
