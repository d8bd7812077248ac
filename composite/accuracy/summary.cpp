#include "composite/accuracy/summary.h"

#include <fmt/format.h>

#include <cmath>
#include <set>
#include <utility>

namespace inlay {
namespace {

std::string figure(double value, int digits) {
    return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::string figure(const std::optional<double>& value, int digits) {
    return value ? figure(*value, digits) : "-";
}

std::string row(const std::vector<std::string>& cells) {
    return "| " + fmt::format("{}", fmt::join(cells, " | ")) + " |\n";
}

std::string table_head(const std::vector<std::string>& titles) {
    return row(titles) + row(std::vector<std::string>(titles.size(), "---"));
}

std::string shown(const std::string& method, bool temporal) {
    return method_named(method).title + (temporal ? ", previous frame" : "");
}

std::string bound(bool beyond) { return beyond ? "> " : ""; }

std::string head_text(const AccuracyReport& report) {
    return fmt::format(
        "# What accuracy costs in time\n\n"
        "Written by `inlay accuracy` {}, {}, on {}, threads {}; repeats {}, seed {}{}.\n\n"
        "RMSE is that of linear radiance (1 is full white) over the pixels that objects "
        "influence, against the converged\nreference. ms is the time of tracing, filter and "
        "composite of a frame, median over repeats. A method with a width\nstands with the best "
        "of those tried, which needs the reference; the axis-aligned filters find theirs "
        "themselves.\n",
        report.program, report.date.substr(0, 10), report.machine.cpu, report.machine.threads,
        report.repeats, report.seed, report.quick ? ", quick" : "");
}

std::string work_text(const WorkReport& work) {
    return fmt::format(
        "\n## {}\n\nA {} of {} x {} px, frames {}, B_e {} / rad. The converged reference has {} "
        "samples per pixel\nand a standard error of {}, the truth {} and {}.\n",
        work.name, work.kind, work.width, work.height, fmt::join(work.frames, ", "),
        figure(work.environment_bandwidth, 1), work.converged_samples,
        figure(work.converged_standard_error, 4),
        work.truth_samples > 0 ? std::to_string(work.truth_samples) : "-",
        figure(work.truth_samples > 0 ? std::optional(work.truth_standard_error) : std::nullopt,
               4));
}

std::string equal_error_text(const WorkReport& work, const PriceList& prices) {
    std::string text =
        "\nEqual error: what unfiltered sampling takes to come as close as 16 "
        "samples with the method do.\n\n";
    text += table_head({"work", "method", "RMSE", "ms", "unfiltered ms", "unfiltered samples",
                        "times as long", "FLIP ratio"});
    for (const EqualError& e : prices.equal_error)
        text += row({work.name, shown(e.method, e.temporal), figure(e.error, 4),
                     figure(e.filtered_ms, 1), bound(e.beyond) + figure(e.unfiltered_ms, 1),
                     bound(e.beyond) + figure(e.unfiltered_samples, 0),
                     bound(e.beyond) + figure(e.speed_up, 1), figure(e.flip_ratio, 2)});
    return text;
}

std::string equal_time_text(const WorkReport& work, const PriceList& prices) {
    std::string text =
        "\nEqual time: each method in the time of the default filter with 16 "
        "samples; ratios above 1 speak for the default.\n\n";
    text += table_head({"work", "method", "ms", "RMSE", "RMSE ratio", "FLIP ratio"});
    for (const EqualTime& e : prices.equal_time) {
        const std::string most = e.beyond ? "< " : "";  // more samples would only bring it closer
        text +=
            row({work.name, shown(e.method, e.temporal), figure(e.ms, 1), most + figure(e.rmse, 4),
                 most + figure(e.rmse_ratio, 2), most + figure(e.flip_ratio, 2)});
    }
    return text;
}

bool counts(const Cell& cell) {
    return cell.knob == "samples" && cell.failed.empty() && cell.converged &&
           cell.converged->rmse_influenced && *cell.converged->rmse_influenced > 0;
}

/// "0.0123 at 4, 0.0061 at 16": of the cells that one method has.
std::string errors_text(const std::vector<Cell>& cells, const Cell& of) {
    std::vector<std::string> errors;
    for (const Cell& cell : cells)
        if (counts(cell) && cell.method == of.method && cell.temporal == of.temporal)
            errors.push_back(figure(cell.converged->rmse_influenced, 4) + " at " + cell.value);
    return fmt::format("{}", fmt::join(errors, ", "));
}

std::string slopes_text(const WorkReport& work) {
    std::string rows;
    std::set<std::pair<std::string, bool>> seen;
    for (const Cell& cell : work.cells)
        if (counts(cell) && seen.insert({cell.method, cell.temporal}).second)
            rows +=
                row({work.name, shown(cell.method, cell.temporal), errors_text(work.cells, cell),
                     figure(error_slope(work.cells, cell.method, cell.temporal), 2)});
    if (rows.empty()) return "";
    return "\nError with samples: the slope of log RMSE over log samples; -0.50 is noise of "
           "independent samples alone, 0.00 bias\nalone.\n\n" +
           table_head({"work", "method", "RMSE at samples", "slope"}) + rows;
}

/// "0.0123 of 0.0456", and a mark where it is over.
std::string budgeted(const BudgetedFigure& f, int digits) {
    return fmt::format("{} of {}{}", figure(f.value, digits), figure(f.allowed, digits),
                       f.kept() ? "" : " (over)");
}

std::string budget_text(const WorkReport& work) {
    std::string text =
        "\nBudget: the composite's errors against truth, of what was derived for them before: what "
        "the reference mode reaches in\nthe true room and what samples, sensor and poses add. RMSE "
        "over influenced pixels, relative RMSE of the irradiances,\nRMS change of a still "
        "camera's picture.\n\n";
    std::vector<std::string> titles{"work", "frame"};
    for (const BudgetedFigure& f : figures_of(work.verdicts.front()))
        titles.push_back(f.name);
    text += table_head(titles);
    for (const FrameVerdict& verdict : work.verdicts) {
        std::vector<std::string> cells{work.name, std::to_string(verdict.frame)};
        for (const BudgetedFigure& f : figures_of(verdict))
            cells.push_back(budgeted(f, 4));
        text += row(cells);
    }
    return text;
}

std::string blame_text(const WorkReport& work) {
    std::string text =
        "\nBlame: the share of the mean square error against truth that goes away "
        "with the truth in place of one stage.\n\n";
    text += blame_table_head();
    for (const FrameBlame& blame : work.blame)
        text += blame_table_row(work.name, blame);
    return text;
}

std::string failures_text(const WorkReport& work) {
    std::string text;
    for (const Cell& cell : work.cells)
        if (!cell.failed.empty()) text += "\n- failed: " + cell.id + ": " + cell.failed;
    for (const Cell& cell : work.cells)
        for (const FailedRepeat& f : cell.failed_repeats)
            text +=
                fmt::format("\n- failed in repeat {}: {}: {}", f.repeat + 1, cell.id, f.message);
    return text.empty() ? text : text + "\n";
}

}  // namespace

std::string blame_table_head() {
    std::vector<std::string> titles{"work", "frame", "RMSE", "photograph alone", "all stages true",
                                    "blame"};
    for (const Stage stage : all_stages)
        titles.emplace_back(name_of(stage));
    return table_head(titles);
}

std::string blame_table_row(const std::string& work, const FrameBlame& blame) {
    std::vector<std::string> cells{work,
                                   std::to_string(blame.frame),
                                   figure(blame.rmse, 4),
                                   figure(blame.photograph_rmse, 4),
                                   figure(blame.best_rmse, 4),
                                   name_of(blame.culprit)};
    for (const StageBlame& stage : blame.stages)
        cells.push_back(figure(100 * stage.share, 0) + " %");
    return row(cells);
}

std::optional<double> error_slope(const std::vector<Cell>& cells, const std::string& method,
                                  bool temporal) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const Cell& cell : cells) {
        if (!counts(cell) || cell.method != method || cell.temporal != temporal) continue;
        const double u = std::log(double(cell.primary) * cell.secondary);
        const double v = std::log(*cell.converged->rmse_influenced);
        n += 1;
        x += u;
        y += v;
        xx += u * u;
        xy += u * v;
    }
    const double spread = n * xx - x * x;
    if (n < 2 || !(spread > 0)) return std::nullopt;
    return (n * xy - x * y) / spread;
}

std::string summary_text(const AccuracyReport& report) {
    std::string text = head_text(report);
    for (const WorkReport& work : report.works) {
        const PriceList prices = price_list(work.cells);
        text += work_text(work);
        if (!prices.equal_error.empty()) text += equal_error_text(work, prices);
        if (!prices.equal_time.empty()) text += equal_time_text(work, prices);
        text += slopes_text(work);
        if (!work.verdicts.empty()) text += budget_text(work);
        if (!work.blame.empty()) text += blame_text(work);
        text += failures_text(work);
    }
    return text;
}

}  // namespace inlay
