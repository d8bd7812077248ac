#include "composite/govern/governor.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace inlay {
namespace {

/// Shares of what is asked for that a choice aims at: frames differ from those before them. That of
/// time is nearer to 1, since four samples fewer already leave a part of it unused.
constexpr double time_aim = 0.98, error_aim = 0.95;
/// Weight of a new frame: half of what is known is two frames old.
constexpr double time_rate = 0.3;
/// Errors are estimated seldom, and change slowly.
constexpr double error_rate = 0.5;
/// A single frame moves a factor by this much at most: a pause of the machine is no price.
constexpr double largest_step = 4;

double moved(double from, double to, double rate) {
    if (!(from > 0)) return to;
    return from + rate * (std::clamp(to, from / largest_step, from * largest_step) - from);
}

Choice predict(const Governor& g, int samples, bool extracts) {
    const double other = g.other_ms + (extracts ? g.extraction_ms : 0.0);
    return {samples, other + g.time_factor * ms_at(g.front, samples),
            g.error_factor * error_at(g.front, samples)};
}

bool does(const Goal& goal, const Choice& choice) {
    return goal.ms_per_frame ? choice.ms <= time_aim * *goal.ms_per_frame
                             : choice.error <= error_aim * *goal.error;
}

/// The rest of a frame, which takes longer where the model is extracted.
void learn_other(Governor& governor, double ms, bool extracted) {
    if (extracted) {
        // How much of it is the extraction, an ordinary frame will tell.
        double& learned = governor.knows_other ? governor.extraction_ms : governor.other_ms;
        const double ordinary = governor.knows_other ? governor.other_ms : 0.0;
        learned = moved(learned, std::max(0.0, ms - ordinary), time_rate);
    } else if (governor.knows_other) {
        governor.other_ms = moved(governor.other_ms, ms, time_rate);
    } else {
        const double first = governor.other_ms;
        governor.other_ms = std::min(ms, first);
        governor.extraction_ms = first - governor.other_ms;
        governor.knows_other = true;
    }
}

}  // namespace

void validate(const Goal& goal) {
    require(goal.ms_per_frame.has_value() != goal.error.has_value(),
            "--time-per-frame and --error: expected one of the two", ExitCode::usage);
    require(!goal.ms_per_frame || (std::isfinite(*goal.ms_per_frame) && *goal.ms_per_frame > 0),
            "--time-per-frame: expected a positive number of milliseconds", ExitCode::usage);
    require(!goal.error || (std::isfinite(*goal.error) && *goal.error >= 0),
            "--error: expected an RMSE of linear radiance, 0 or more", ExitCode::usage);
}

Governor start_governor(const Goal& goal, PriceFront front) {
    validate(goal);
    Governor governor;
    governor.goal = goal;
    governor.other_ms = front.other_ms;
    governor.front = std::move(front);
    return governor;
}

Choice choose(const Governor& governor, bool extracts) {
    const std::vector<int> ladder = sample_ladder();
    if (governor.goal.ms_per_frame) {
        Choice best = predict(governor, ladder.front(), extracts);
        for (const int samples : ladder) {
            const Choice choice = predict(governor, samples, extracts);
            if (does(governor.goal, choice)) best = choice;
        }
        return best;
    }
    for (const int samples : ladder) {
        const Choice choice = predict(governor, samples, extracts);
        if (does(governor.goal, choice)) return choice;
    }
    return predict(governor, ladder.back(), extracts);
}

void learn(Governor& governor, const Choice& choice, const Reached& reached) {
    learn_other(governor, reached.other_ms, reached.extracted);
    const double expected = ms_at(governor.front, choice.samples);
    if (reached.sampling_ms > 0 && expected > 0)
        governor.time_factor =
            moved(governor.time_factor, reached.sampling_ms / expected, time_rate);
    if (reached.error && std::isfinite(*reached.error) && *reached.error > 0)
        governor.error_factor = moved(governor.error_factor, *reached.error, error_rate);
}

}  // namespace inlay
