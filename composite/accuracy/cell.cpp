#include "composite/accuracy/cell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

namespace inlay {
namespace {

/// All repeats of one method at one width in one unit.
struct Group {
    std::vector<const UnitRun*> units;
    std::string method;
    bool temporal = false;
    double width = 0;

    std::vector<const MethodRun*> runs_of(const UnitRun& unit) const {
        std::vector<const MethodRun*> runs;
        for (const MethodRun& run : unit.runs)
            if (run.method == method && run.temporal == temporal && run.width == width)
                runs.push_back(&run);
        return runs;
    }

    /// What the method said when it failed in a unit; "" where it did not.
    std::string failure_in(const UnitRun& unit) const {
        for (const MethodRun* run : runs_of(unit))
            if (!run->failed.empty()) return run->failed;
        return "";
    }
};

/// Without the units in which the method failed: these hold no measurement of it.
Group finished(const Group& group) {
    Group result = group;
    std::erase_if(result.units,
                  [&](const UnitRun* unit) { return !group.failure_in(*unit).empty(); });
    return result;
}

std::vector<FailedRepeat> failures_of(const Group& group) {
    std::vector<FailedRepeat> failures;
    for (const UnitRun* unit : group.units)
        if (const std::string message = group.failure_in(*unit); !message.empty())
            failures.push_back({unit->repeat, message});
    return failures;
}

using ErrorOf = std::optional<FrameError> MethodRun::*;

std::optional<CellError> error_of(const std::vector<const MethodRun*>& runs, ErrorOf kind) {
    double all = 0, influenced = 0, power = 0;
    int frames = 0, influenced_frames = 0;
    CellError sum{0, {}, 0, 0, 0, 0};
    for (const MethodRun* run : runs) {
        const std::optional<FrameError>& error = run->*kind;
        if (!error) continue;
        ++frames;
        all += error->mean_square;
        power += error->reference_power;
        sum.psnr += error->psnr;
        sum.ssim += error->ssim;
        sum.flip += error->flip;
        if (!error->influenced) continue;
        ++influenced_frames;
        influenced += error->mean_square_influenced;
    }
    if (frames == 0) return std::nullopt;
    const double n = frames;
    CellError result{std::sqrt(all / n), {}, 0, sum.psnr / n, sum.ssim / n, sum.flip / n};
    if (influenced_frames > 0) result.rmse_influenced = std::sqrt(influenced / influenced_frames);
    result.relative_rmse = power > 0 ? std::sqrt(all / power) : 0;
    return result;
}

/// What ranks widths; infinite where nothing was measured, or not every frame.
double rank_of(const std::vector<const MethodRun*>& runs) {
    constexpr double nothing = std::numeric_limits<double>::infinity();
    for (const MethodRun* run : runs)
        if (!run->failed.empty()) return nothing;
    for (const ErrorOf kind : {&MethodRun::converged, &MethodRun::truth}) {
        const auto error = error_of(runs, kind);
        if (error) return error->rmse_influenced.value_or(error->rmse);
    }
    return nothing;
}

std::optional<double> influenced_rmse(const std::optional<FrameError>& error) {
    if (!error || !error->influenced) return std::nullopt;
    return std::sqrt(error->mean_square_influenced);
}

Spread mean_over_frames(const Group& group, const auto& value) {
    std::vector<double> means;
    for (const UnitRun* unit : group.units) {
        const auto runs = group.runs_of(*unit);
        double sum = 0;
        for (std::size_t i = 0; i < runs.size(); ++i) {
            for (const FrameRun& frame : unit->frames)
                if (frame.frame == runs[i]->frame) sum += value(frame, *runs[i]);
        }
        if (!runs.empty()) means.push_back(sum / double(runs.size()));
    }
    return spread_of(std::move(means));
}

const Cost& trace_of(const FrameRun& frame, const MethodRun& run) {
    return run.trace ? *run.trace : frame.trace;
}

StageSpreads stages_of(const Group& group, double Cost::*clock) {
    StageSpreads s;
    s.slam = mean_over_frames(group, [](const FrameRun& f, const MethodRun&) { return f.slam_ms; });
    s.trace = mean_over_frames(
        group, [=](const FrameRun& f, const MethodRun& r) { return trace_of(f, r).*clock; });
    s.filter = mean_over_frames(
        group, [=](const FrameRun&, const MethodRun& r) { return r.filter.*clock; });
    s.composite = mean_over_frames(
        group, [=](const FrameRun&, const MethodRun& r) { return r.composite.*clock; });
    s.total = mean_over_frames(group, [=](const FrameRun& f, const MethodRun& r) {
        return trace_of(f, r).*clock + r.filter.*clock + r.composite.*clock;
    });
    return s;
}

std::vector<CellFrame> frames_of(const Group& group) {
    std::vector<CellFrame> result;
    for (const MethodRun* run : group.runs_of(*group.units.front())) {
        const auto& seen = run->converged ? run->converged : run->truth;
        CellFrame frame{run->frame,
                        influenced_rmse(run->converged),
                        influenced_rmse(run->truth),
                        seen ? seen->psnr : 0,
                        seen ? seen->flip : 0,
                        0};
        std::vector<double> ms;
        for (const UnitRun* unit : group.units)
            for (const MethodRun* again : group.runs_of(*unit))
                for (const FrameRun& f : unit->frames)
                    if (f.frame == run->frame && again->frame == run->frame)
                        ms.push_back(trace_of(f, *again).wall_ms + again->filter.wall_ms +
                                     again->composite.wall_ms);
        frame.ms = spread_of(std::move(ms)).median;
        result.push_back(frame);
    }
    return result;
}

RayCounts mean_rays(const UnitRun& unit, const std::vector<const MethodRun*>& runs) {
    RayCounts mean;
    const auto n = std::uint64_t(std::max<std::size_t>(1, runs.size()));
    for (std::uint64_t RayCounts::*kind :
         {&RayCounts::primary, &RayCounts::virtual_shadow, &RayCounts::virtual_indirect,
          &RayCounts::real_shadow, &RayCounts::real_indirect}) {
        for (const MethodRun* run : runs)
            for (const FrameRun& frame : unit.frames)
                if (frame.frame == run->frame)
                    mean.*kind += (run->rays ? *run->rays : frame.rays).*kind;
        mean.*kind /= n;
    }
    return mean;
}

/// Root of the mean over frames of the squared changes.
std::optional<double> flicker_of(const std::vector<const MethodRun*>& runs) {
    double squares = 0;
    int counted = 0;
    for (const MethodRun* run : runs) {
        if (!run->flicker) continue;
        squares += *run->flicker * *run->flicker;
        ++counted;
    }
    if (counted == 0) return std::nullopt;
    return std::sqrt(squares / counted);
}

Cell cell_of(const Group& all) {
    const UnitRun& first = *all.units.front();
    const auto runs = all.runs_of(first);
    Cell cell;
    cell.knob = first.knob;
    cell.value = first.value;
    cell.method = all.method;
    cell.temporal = all.temporal;
    cell.id = first.knob + "=" + first.value + "/" + all.method + (all.temporal ? "/temporal" : "");
    if (all.width != 0) cell.width = all.width;
    cell.primary = first.primary;
    cell.secondary = first.secondary;
    cell.failed = all.failure_in(first);
    if (!cell.failed.empty()) return cell;
    cell.failed_repeats = failures_of(all);
    const Group group = finished(all);
    cell.wall = stages_of(group, &Cost::wall_ms);
    cell.cpu = stages_of(group, &Cost::cpu_ms);
    cell.rays = mean_rays(first, runs);
    cell.peak_mb = first.peak_mb;
    cell.converged = error_of(runs, &MethodRun::converged);
    cell.truth = error_of(runs, &MethodRun::truth);
    cell.flicker = flicker_of(runs);
    cell.frames = frames_of(group);
    return cell;
}

/// The units of one knob's value, first repeat first.
using Repeats = std::vector<const UnitRun*>;

void add_cells(const Repeats& repeats, std::vector<Cell>& cells) {
    std::vector<std::pair<std::string, bool>> seen;
    for (const MethodRun& run : repeats.front()->runs) {
        const std::pair key{run.method, run.temporal};
        if (std::find(seen.begin(), seen.end(), key) != seen.end()) continue;
        seen.push_back(key);
        Group best{repeats, run.method, run.temporal, run.width};
        double least = rank_of(best.runs_of(*repeats.front()));
        for (const MethodRun& other : repeats.front()->runs) {
            if (std::pair{other.method, other.temporal} != key) continue;
            const Group group{repeats, run.method, run.temporal, other.width};
            const double rank = rank_of(group.runs_of(*repeats.front()));
            if (rank < least) {
                least = rank;
                best = group;
            }
        }
        cells.push_back(cell_of(best));
    }
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const std::size_t n = values.size();
    return {0.5 * (values[(n - 1) / 2] + values[n / 2]), values.front(), values.back()};
}

std::vector<Cell> cells_of(const std::vector<UnitRun>& units) {
    std::vector<std::pair<std::string, Repeats>> settings;
    for (const UnitRun& unit : units) {
        const std::string key = unit.knob + "=" + unit.value;
        auto found = std::find_if(settings.begin(), settings.end(),
                                  [&](const auto& s) { return s.first == key; });
        if (found == settings.end()) found = settings.insert(settings.end(), {key, {}});
        found->second.push_back(&unit);
    }
    std::vector<Cell> cells;
    for (auto& [key, repeats] : settings) {
        std::stable_sort(repeats.begin(), repeats.end(),
                         [](const UnitRun* a, const UnitRun* b) { return a->repeat < b->repeat; });
        add_cells(repeats, cells);
    }
    return cells;
}

}  // namespace inlay
