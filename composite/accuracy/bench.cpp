#include "composite/accuracy/bench.h"

#include "composite/accuracy/judged_frames.h"
#include "composite/accuracy/run_file.h"
#include "composite/accuracy/unit_json.h"
#include "composite/accuracy/work_report.h"
#include "composite/write/atomic_file.h"
#include "recordings/base/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

namespace inlay {
namespace {

namespace fs = std::filesystem;

constexpr int most_samples_with_flicker = 64;

/// A value of a knob on a work: a row of units, one per repeat.
struct Row {
    std::size_t work = 0;
    Knob knob;
    std::string value;
    Sampling sampling;
};

/// Reconstructions that rows share.
using Reconstructions = std::map<std::string, std::vector<JudgedFrame>>;

bool is_named(const std::vector<std::string>& only, const std::string& name) {
    return std::find(only.begin(), only.end(), name) != only.end();
}

bool names_any_knob(const std::vector<std::string>& only) {
    for (const Knob& knob : knobs(false))
        if (is_named(only, knob.name)) return true;
    return false;
}

bool names_any_method(const std::vector<std::string>& only) {
    for (const Method& method : methods())
        if (is_named(only, method.name)) return true;
    return false;
}

std::vector<Row> rows_of(const std::vector<Work>& works, const BenchOptions& options) {
    std::vector<Row> rows;
    const bool all_knobs = !names_any_knob(options.only);
    for (const Knob& knob : knobs(options.quick)) {
        if (!all_knobs && !is_named(options.only, knob.name)) continue;
        for (const std::string& value : knob.values) {
            for (std::size_t w = 0; w < works.size(); ++w) {
                if (knob.needs_tracking && !works[w].recording) continue;
                if (knob.needs_room && !works[w].knows_room) continue;
                Row row{w, knob, value, {options.settings}};
                knob.turn(row.sampling, value);
                rows.push_back(std::move(row));
            }
        }
    }
    return rows;
}

/// What decides a reconstruction: everything that happens before sampling.
std::string reconstruction_key(const Row& row) {
    std::string key = std::to_string(row.work) +
                      (row.sampling.depth == SensorDepth::exact ? " exact" : " recorded");
    for (const SettingRow& setting : setting_rows())
        if (setting.name.rfind("slam.", 0) == 0 || setting.name.rfind("geometry.", 0) == 0)
            key += " " + setting.get(row.sampling.settings);
    return key;
}

std::vector<MethodCell> cells_to_try(const Row& row, const BenchOptions& options) {
    const bool all_methods = !names_any_method(options.only);
    std::vector<MethodCell> cells;
    for (const Method& method : methods()) {
        const bool is_default = method.name == default_method;
        const bool is_plain = method.name == "unfiltered";
        if (!all_methods && !is_named(options.only, method.name)) continue;
        if (!row.knob.all_methods && !is_default && !(is_plain && row.knob.name == "split"))
            continue;
        const std::vector<double> widths =
            method.widths.empty() ? std::vector<double>{0} : method.widths;
        for (const bool temporal : {false, true}) {
            if (temporal && (is_plain || !row.knob.all_methods)) continue;
            for (const double width : widths)
                cells.push_back({&method, temporal, width});
        }
    }
    return cells;
}

/// Of each method the width that came out best in the first repeat.
std::vector<MethodCell> best_cells(const UnitRun& first) {
    std::vector<MethodCell> cells;
    for (const Cell& cell : cells_of({first}))
        if (cell.failed.empty())
            cells.push_back({&method_named(cell.method), cell.temporal, cell.width.value_or(0)});
    return cells;
}

fs::path unit_file(const fs::path& folder, const Work& work, const Row& row, int repeat) {
    return folder / "units" /
           fmt::format("{}.{}={}.{}.json", work.name, row.knob.name, row.value, repeat);
}

std::string text_of(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

class Runner {
public:
    Runner(const std::vector<Work>& works, const BenchOptions& options, const fs::path& folder,
           const BenchWatcher& watcher)
        : works_(works), options_(options), folder_(folder), watcher_(watcher) {}

    /// False when it was interrupted.
    bool measure() {
        const std::vector<Row> rows = rows_of(works_, options_);
        const int total = options_.repeats * int(rows.size());
        int done = 0;
        for (int repeat = 0; repeat < options_.repeats; ++repeat) {
            for (const Row& row : rows) {
                if (watcher_.interrupted()) return false;
                add_unit(row, repeat);
                watcher_.units_done(++done, total);
            }
        }
        return true;
    }

    const std::vector<UnitRun>& units() const { return units_; }

    /// Of the program's own settings.
    const std::vector<JudgedFrame>& default_frames(std::size_t work) {
        return frames_of({work, {}, "", {options_.settings}});
    }

private:
    /// A setting under which a work cannot be reconstructed is reported, and the rest goes on.
    void add_unit(const Row& row, int repeat) {
        try {
            units_.push_back(unit(row, repeat));
        } catch (const Error& error) {
            const bool own = reconstruction_key(row) != default_key(row);
            if (!own || error.code() != ExitCode::bad_data) throw;
            watcher_.warn(fmt::format("{}, {}={}: {}", works_[row.work].name, row.knob.name,
                                      row.value, error.what()));
        }
    }

    UnitRun unit(const Row& row, int repeat) {
        const fs::path file = unit_file(folder_, works_[row.work], row, repeat);
        if (fs::exists(file)) return unit_from_json(text_of(file), file.string());
        UnitPlan plan{row.knob.name, row.value, row.sampling.settings, {}, repeat == 0, false};
        plan.light_list = row.sampling.light_list;
        plan.cells = repeat == 0 ? cells_to_try(row, options_) : best_cells(first_of(row));
        const int samples = plan.settings.trace.primary * plan.settings.trace.secondary;
        plan.with_flicker =
            repeat == 0 && row.knob.all_methods && samples <= most_samples_with_flicker;
        UnitRun run = measure_unit(works_[row.work], frames_of(row), plan);
        run.repeat = repeat;
        for (const MethodRun& method : run.runs)
            if (!method.failed.empty())
                watcher_.warn(fmt::format("{}, {}={}, {}: {}", run.work, run.knob, run.value,
                                          method.method, method.failed));
        write_text(file, to_json_text(run));
        return run;
    }

    UnitRun first_of(const Row& row) const {
        for (const UnitRun& unit : units_)
            if (unit.work == works_[row.work].name && unit.knob == row.knob.name &&
                unit.value == row.value && unit.repeat == 0)
                return unit;
        return {};
    }

    const std::vector<JudgedFrame>& frames_of(const Row& row) {
        const std::string key = reconstruction_key(row);
        auto found = reconstructions_.find(key);
        if (found != reconstructions_.end()) return found->second;
        const Work& work = works_[row.work];
        const auto frames = judge_frames(
            work, measured_frames(work, options_.wanted_frame), row.sampling,
            row.knob.against_truth && key != default_key(row) ? 0 : options_.converged_samples);
        return reconstructions_.emplace(key, frames).first->second;
    }

    std::string default_key(const Row& row) const {
        return reconstruction_key({row.work, {}, "", {options_.settings}});
    }

    const std::vector<Work>& works_;
    const BenchOptions& options_;
    const fs::path& folder_;
    const BenchWatcher& watcher_;
    std::vector<UnitRun> units_;
    Reconstructions reconstructions_;
};

/// Units and pictures are filed under the names of works.
void require_own_names(const std::vector<Work>& works) {
    std::set<std::string> names;
    for (const Work& work : works)
        require(names.insert(work.name).second,
                "two works are named " + work.name + "; rename one, or measure them apart",
                ExitCode::usage);
}

}  // namespace

void validate(const BenchOptions& options) {
    validate(options.settings);
    require(options.repeats >= 1, "--repeat must be 1 or more", ExitCode::usage);
    require(options.converged_samples >= 2, "--reference-samples must be 2 or more",
            ExitCode::usage);
    std::vector<std::string> known;
    for (const Knob& knob : knobs(false))
        known.push_back(knob.name);
    for (const std::string& name : options.only)
        if (!is_named(known, name)) method_named(name);
}

BenchResult run_bench(const std::vector<Work>& works, const BenchOptions& options,
                      const fs::path& folder, const BenchWatcher& watcher) {
    validate(options);
    require_own_names(works);
    make_folder(folder / "units");
    const RunFacts facts = open_run(works, options, folder);
    Runner runner(works, options, folder, watcher);
    BenchResult result;
    result.report = {options.program, facts.date,
                     facts.machine,   options.settings,
                     options.repeats, options.settings.trace.seed,
                     options.quick,   {}};
    result.complete = runner.measure();
    if (!result.complete) return result;
    for (std::size_t w = 0; w < works.size(); ++w) {
        result.report.works.push_back(report_work(
            works[w], {runner.default_frames(w), runner.units()}, options, folder, watcher));
    }
    return result;
}

}  // namespace inlay
