// FrameBudget: how far a composite may be from the truth, derived before it is made.
#pragma once

#include "composite/accuracy/irradiance_error.h"
#include "composite/accuracy/sensor_bounds.h"
#include "composite/accuracy/unit.h"

#include <string>

namespace inlay {

/// RMSE over the influenced pixels, relative radiance. Every part is measured with samples that
/// nothing is judged by, and the noise of what it is measured against is taken out.
struct FrameBudget {
    double equation = 0;       // the reference mode with true room and pose: eq. 6.2 itself
    double seen = 0;           // the same in the room that exact depth and poses have shown so far
    double sampling = 0;       // the setting's samples and filter against that reference mode
    double displaced_px = 0;   // by how much pose and depth are off, in the image
    double displacement = 0;   // the truth against itself, displaced by as much
    double total = 0;          // what is allowed
    double e_r = 0, e_rv = 0;  // allowed relative RMSE of the irradiances
    double flicker = 0;  // allowed RMS change of a still camera's picture: unfiltered noise alone
    SensorBounds bounds;
};

/// Light of the reference mode, unfiltered, in two halves of independent samples.
struct ConvergedLight {
    Layers a, b;
    LightPair pair() const { return {a, b}; }
};
/// Of seeds that no measurement has; `samples` per pixel of both halves together.
ConvergedLight converged_light(const Work& work, const TrackedFrame& frame,
                               const Settings& settings, int samples);

/// The parts add as squares, since they do not know of each other; `slack` covers what they share.
/// What tracking and fusion add to the picture, `seen` and `displaced_px`, and to the irradiances
/// counts up to what sensor_bounds() leave and no further, so that a tracker or a model that is
/// worse does not allow itself more. `frame` is the tracked one, `wanted` the light of its
/// true_frame() from `converged_samples`. Throws Error where the work has no truth, room or pose
/// for it.
FrameBudget frame_budget(const Work& work, const TrackedFrame& frame, const Settings& settings,
                         const ConvergedLight& wanted, int converged_samples, double slack = 1.5);

/// The layers of a frame from the settings' samples, filtered as they say; `seed_offset` makes them
/// independent of those of other offsets.
Layers light_of(const Work& work, const TrackedFrame& frame, const Settings& settings,
                std::uint32_t seed_offset = 0);

/// The frame with the true room, pose and photograph. Throws Error where the work does not know
/// them.
TrackedFrame true_frame(const Work& work, const TrackedFrame& frame);

/// One line with every part.
std::string budget_line(const FrameBudget& budget);

}  // namespace inlay
