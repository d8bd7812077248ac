// From no knowledge to the mapping, and what is uncertain about it.
#pragma once

#include "slam/registration/solve_mapping.h"

#include <span>
#include <vector>

namespace inlay {

/// What the recording can tell.
struct MappingUnknowns {
    bool delay = true;      // the camera's motion is known
    bool log_focal = true;  // the color camera's focal length is not
};

/// The best of many starts, on a part of the frames: within 30 mm of baseline, 0.03 rad, and -20 to
/// +10 % of focal length. Good to about a pixel.
ColorMapping search_mapping(const RimViews& problem, const MappingUnknowns& unknowns);

/// Refines a mapping on the chosen frames: stage by stage closer edges count. `first_stage` 0 may
/// be off by 10 px, 1 by 6, 2 by 3.
ColorMapping refine_mapping(const RimViews& problem, std::span<const int> chosen,
                            const ColorMapping& start, const MappingUnknowns& unknowns,
                            int first_stage);

/// A part of the recording that a mapping was not estimated from.
struct HeldOut {
    std::vector<int> frames;
    ColorMapping mapping;  // estimated from all others
};

/// Leaves out a quarter of the recording at a time (a third if there are less than 12 frames) and
/// refines `mapping` on what remains. The problem has three frames at least.
std::vector<HeldOut> hold_out(const RimViews& problem, const ColorMapping& mapping,
                              const MappingUnknowns& unknowns);

struct MappingUncertainty {
    MappingStep parameters{};  // standard deviations; see MappingParameter
    double px = 0;             // likewise of the rims' positions, rms
};

/// The grouped jackknife: variance = (n - 1)/n times the sum of squared deviations from `mapping`.
/// Efron and Stein 1981, eq. 1.4, about the estimate from everything instead of the mean.
MappingUncertainty uncertainty_of(const RimViews& problem, const ColorMapping& mapping,
                                  std::span<const HeldOut> held_out);

}  // namespace inlay
