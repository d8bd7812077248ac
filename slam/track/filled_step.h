// Brightness fills in the step where the surfaces leave the camera free.
#pragma once

#include "slam/track/constrained_step.h"
#include "slam/track/photometric_system.h"

namespace inlay {

/// When brightness may speak.
struct BrightnessTrust {
    double least_information = 0.01;  // of the trace of A's block of translations: directions with
                                      // less are not moved; noise across an edge feigns some
    double least_share = 0.02;        // of the points seen in both that must have a slope
};

/// `step`, which constrained_step() made of `surfaces`, and in the directions that it left free the
/// one that explains the brightness best once the first is taken. The first is never contradicted,
/// so that the scales of the two systems need no balance.
ConstrainedStep filled_step(const ConstrainedStep& step, const IcpSystem& surfaces,
                            const PhotometricSystem& brightness, const BrightnessTrust& trust);

}  // namespace inlay
