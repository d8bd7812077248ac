// The governor: buys by time or by error, frame after frame.
#pragma once

#include "composite/govern/price_front.h"

#include <optional>

namespace inlay {

/// What the user asks for; one of them.
struct Goal {
    std::optional<double> ms_per_frame;  // > 0, wall time of a whole frame
    std::optional<double> error;         // >= 0, as of PricePoint
};

/// Throws Error (usage) unless exactly one is given, finite and in its range.
void validate(const Goal& goal);

/// What a frame is to be sampled with, and what that should come to.
struct Choice {
    int samples = 0;
    double ms = 0;     // of the whole frame
    double error = 0;  // as of PricePoint
};

/// What became of it.
struct Reached {
    double sampling_ms = 0;       // tracing and filtering; 0: it teaches nothing of these
    double other_ms = 0;          // the rest of the frame
    bool extracted = false;       // the model was extracted anew in it
    std::optional<double> error;  // estimated, over the front's at the samples that were estimated
};

/// The front says how time and error follow the samples; the frames, how far the present ones lie
/// from it.
struct Governor {
    Goal goal;
    PriceFront front;
    double other_ms = 0;       // of the frames so far, without what follows
    double extraction_ms = 0;  // more, in frames that extract the model anew
    bool knows_other = false;  // false: `other_ms` is the first frame's, with all that is in it
    double time_factor = 1;    // of the front's times
    double error_factor = 1;   // of the front's errors
};

Governor start_governor(const Goal& goal, PriceFront front);

/// By time: the most samples whose frame should be done in time, with a little to spare. By error:
/// the fewest that should do. Where none do, those that come nearest. `extracts`: the frame will
/// extract the model anew.
Choice choose(const Governor& governor, bool extracts = false);

/// Moves the factors towards what the last frame showed.
void learn(Governor& governor, const Choice& choice, const Reached& reached);

}  // namespace inlay
