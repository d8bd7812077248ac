// Displacement: how far a reconstruction is off in the image, and what that does to a picture.
#pragma once

#include "composite/accuracy/reference.h"
#include "composite/accuracy/tracked_frame.h"

namespace inlay {

/// How far the tracked frame's real surface lies from where the truth has it, in the image (px, RMS
/// over the pixels where both are known): its pose and its depth together.
double displacement_px(const Work& work, const TrackedFrame& frame, const Pose& true_pose);

/// Mean over the influenced pixels of the squared difference of the truth from itself, displaced by
/// `px` along the image's diagonal; less the noise of both. At least 0.
double displaced_mean_square(const Reference& truth, double px);

}  // namespace inlay
