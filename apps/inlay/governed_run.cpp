#include "apps/inlay/governed_run.h"

#include "composite/govern/front_cache.h"
#include "composite/govern/measure_front.h"
#include "composite/session/stop_watch.h"
#include "composite/write/cache_folder.h"
#include "recordings/base/check.h"

#include <spdlog/spdlog.h>

#include <utility>

namespace inlay {
namespace {

/// Frames from one estimate of the error to the next: each takes as long as several frames.
constexpr int check_interval = 10;

/// Until there are prices.
constexpr int first_samples = 4;

bool has_goal(const GovernedRun& run) { return run.goal.ms_per_frame || run.goal.error; }
bool chooses(const GovernedRun& run) { return has_goal(run) || !run.choices.empty(); }

void keep(const std::string& key, const PriceFront& front) {
    const std::filesystem::path folder = cache_folder();
    if (folder.empty()) return;
    try {
        keep_front(folder, key, front);
    } catch (const Error& e) {
        spdlog::warn("the measured prices are not kept: {}", e.what());
    }
}

}  // namespace

void add_govern_options(CLI::App& subcommand, GovernOptions& o) {
    subcommand.add_option("--time-per-frame", o.goal.ms_per_frame,
                          "ms; choose each frame's samples so that it takes this long");
    subcommand.add_option("--error", o.goal.error,
                          "RMSE of linear radiance over influenced pixels; choose as few samples "
                          "as keep it");
    subcommand.add_option("--choices", o.choices,
                          "run.json of such a run: choose the same samples again");
}

void validate(const GovernOptions& o) {
    const bool goal = o.goal.ms_per_frame || o.goal.error;
    if (goal) validate(o.goal);
    require(!goal || o.choices.empty(),
            "--choices: made by a run before; leave out --time-per-frame and --error",
            ExitCode::usage);
}

GovernedRun start_governed(const SamplingSettings& base, const Goal& goal, std::string price_key,
                           std::map<int, int> choices) {
    GovernedRun run;
    run.base = base;
    run.goal = goal;
    run.price_key = std::move(price_key);
    run.choices = std::move(choices);
    const std::filesystem::path folder = cache_folder();
    if (!has_goal(run) || folder.empty()) return run;
    if (auto front = kept_front(folder, run.price_key))
        run.governor = start_governor(goal, std::move(*front));
    return run;
}

void choose_samples(GovernedRun& run, Session& session, int frame) {
    run.now = std::nullopt;
    run.extracts = model_is_due(session.model, model_age(session), session.settings.geometry);
    if (!chooses(run)) return;
    const auto known = run.choices.find(frame);
    require(known != run.choices.end() || has_goal(run),
            "--choices: frame " + std::to_string(frame) + " has none; leave it out with --frames",
            ExitCode::usage);
    if (known == run.choices.end()) {
        if (run.governor) run.now = choose(*run.governor, run.extracts);
        run.choices[frame] = run.now ? run.now->samples : first_samples;
    }
    session.settings.trace = with_samples(run.base, run.choices[frame]);
}

std::optional<GovernedFrame> note_choice(GovernedRun& run, Session& session, const RgbdFrame& frame,
                                         const OutputFrame& out) {
    if (!chooses(run)) return std::nullopt;
    GovernedFrame note{run.choices[frame.index]};
    if (!run.now) return note;
    note.expected_ms = run.now->ms;
    note.expected_error = run.now->error;
    if (!run.goal.error || !shows_anything(out) || run.until_check-- > 0) return note;
    StopWatch watch;
    if (const auto factor = estimate_error_factor({session, frame, out}, run.governor->front))
        note.estimated_error = *factor * error_at(run.governor->front, run.now->samples);
    note.check_ms = watch.lap();
    run.until_check = check_interval - 1;
    return note;
}

void learn_from(GovernedRun& run, Session& session, const RgbdFrame& frame, const OutputFrame& out,
                const FrameReport& report) {
    if (!has_goal(run) || !shows_anything(out)) return;
    const double other_ms = report.ms.total - out.ms.trace - out.ms.filter;
    if (!run.governor) {
        spdlog::info("frame {}: measuring what samples cost on this machine", frame.index);
        PriceFront front = measure_front({session, frame, out});
        if (front.points.empty()) return;
        front.other_ms = other_ms;
        keep(run.price_key, front);
        run.governor = start_governor(run.goal, std::move(front));
        return;
    }
    if (!run.now) return;
    Reached reached{price_of_samples(out), other_ms, run.extracts, {}};
    if (report.governor && report.governor->estimated_error)
        reached.error =
            *report.governor->estimated_error / error_at(run.governor->front, run.now->samples);
    learn(*run.governor, *run.now, reached);
}

}  // namespace inlay
