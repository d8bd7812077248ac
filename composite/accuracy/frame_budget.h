// FrameBudget: how far a composite may be from the truth, derived before it is made.
#pragma once

#include "composite/accuracy/unit.h"

#include <string>

namespace inlay {

/// RMSE over the influenced pixels, relative radiance.
struct FrameBudget {
    double equation = 0;      // the reference mode with true room and pose: eq. 6.2 itself
    double seen = 0;          // the same in the room that exact depth and poses have shown so far
    double sampling = 0;      // the setting's samples and filter against that reference mode
    double displaced_px = 0;  // by how much pose and depth are off, in the image
    double displacement = 0;  // the truth against itself, displaced by as much
    double total = 0;         // what is allowed
    /// Relative RMSE of the irradiances that sampling and filter alone leave, with true room and
    /// pose.
    double e_r = 0, e_rv = 0;
};

/// The parts add as squares, since they do not know of each other; `slack` covers what they share.
/// `frame` is the tracked one. Throws Error where the work has no truth, room or pose for it.
FrameBudget frame_budget(const Work& work, const TrackedFrame& frame, const Settings& settings,
                         int converged_samples, double slack = 1.5);

/// How far the tracked frame's real surface lies from where the truth has it, in the image (px, RMS
/// over the pixels where both are known): its pose and its depth together.
double displacement_px(const Work& work, const TrackedFrame& frame, const Pose& true_pose);

/// Relative RMSE of filtered irradiances against those of the true room without noise, over pixels
/// that real surfaces cover whole: root of the mean square error over that of the reference.
struct IrradianceError {
    double e_r = 0, e_rv = 0;
    double compared = 0;  // share of the pixels that real surfaces cover whole; the rest are holes
};
IrradianceError irradiance_error(const Layers& layers, const Layers& reference);

/// The layers of a frame, filtered under `settings`; with `converged_samples` > 0 unfiltered from
/// as many samples.
Layers light_of(const Work& work, const TrackedFrame& frame, const Settings& settings,
                int converged_samples = 0);

/// One line with every part.
std::string budget_line(const FrameBudget& budget);

}  // namespace inlay
