// Error without truth: how far a filtered picture is off, from its own samples.
#pragma once

#include "composite/accuracy/unit.h"

#include <optional>
#include <vector>

namespace inlay {

/// Estimated mean square error per pixel of a filtered picture made from half of the samples,
/// against what infinitely many samples would show, with what was found.
struct ErrorEstimate {
    Image<float> mean_square;  // over the channels; smoothed; may be negative where it is noise
    double rmse = 0;           // of the frame, over the influenced pixels
};

/// From pictures of independent samples: `filtered` (first half), and the raw quarters `a` and `b`
/// (second half). The product (filtered - a)(filtered - b) has the mean (filtered - mean)^2, so it
/// sees bias and noise alike and the quarters' own variance drops out. It is averaged over a window
/// of (2 radius + 1)^2 px within the mask.
ErrorEstimate estimate_error(const Image<Rgb>& filtered, const Image<Rgb>& a, const Image<Rgb>& b,
                             const Mask& mask, int radius);

struct EstimatedFrame {
    int frame = 0;
    double estimated_rmse = 0, true_rmse = 0;
};

/// How well the estimate predicts the true error.
struct EstimateQuality {
    double rank_correlation = 0;  // Spearman, of smoothed squared errors over influenced pixels
    double calibration = 0;       // estimated over true mean square, over all frames; 1 is right
    std::vector<EstimatedFrame> frames;
};

/// A share of a setting's samples, whole ones: `samples` per pixel, with as many camera rays as go
/// into them and as `sampling` has at most. Throws Error unless `samples` > 0.
SamplingSettings share_of_samples(SamplingSettings sampling, int samples);

/// Takes a filtered half and two raw quarters of settings.trace's samples of each frame, rounded
/// down but at least one sample each (of two samples, one more is taken), and compares with its
/// `converged` reference; frames without one, or without influenced pixels, are left out. Nothing
/// for a single sample, which has no half, and where no frame is left.
std::optional<EstimateQuality> check_estimate(const Work& work,
                                              const std::vector<JudgedFrame>& frames,
                                              const Settings& settings);

}  // namespace inlay
