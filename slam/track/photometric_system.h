// Two photographs of surfaces -> one 6x6 system of their difference in brightness.
#pragma once

#include "recordings/base/surface_map.h"
#include "slam/track/brightness_map.h"

#include <array>

namespace inlay {

/// A surface and its photograph from the same camera. The photograph may be smaller.
struct SeenBrightness {
    const SurfaceMap& surface;
    const BrightnessMap& brightness;
};

/// Which pixels count, and what makes two photographs alike.
struct BrightnessSettings {
    float distance = 0.04f;      // m, points farther apart are no pair
    float least_slope = 0.008f;  // of the model's value per px; noise makes slopes of its own
    float gain = 1;              // the observed values times it look like the model's
    float scale = 1;             // standard deviation of the residuals, in units of the values
};

/// Normal equations A x = b of the twist x = (rotation, translation), in the frame of the model's
/// camera, that makes the observed points as bright as the model is where they appear. Twist and
/// signs are those of IcpSystem.
struct PhotometricSystem {
    std::array<double, 21> a{};   // upper triangle of A, row by row, in 1/scale^2
    std::array<double, 6> b{};    // likewise
    double squared_residual = 0;  // sum over the inliers
    int seen = 0;                 // points whose brightness is known in both
    int pairs = 0;                // of these, the ones where the model's brightness slopes
    int inliers = 0;              // of these, the ones within 3 scale
};

/// Compares the brightness of each observed point with the model's where `model_from_observed`
/// makes it appear, unless the model's surface there is another one, and linearises the difference
/// (Steinbruecker, Sturm and Cremers 2011, eq. 7 to 12), with Tukey's biweight. The gain between
/// the photographs is one more unknown, eliminated from the system (Schur complement), so that a
/// change of exposure is not taken for motion. Sums are added in the order of the rows: same bytes
/// for any number of threads. `observed` has one lens; the model's photograph is of that level.
PhotometricSystem photometric_system(const SeenBrightness& observed, const SeenBrightness& model,
                                     const Pose& model_from_observed,
                                     const BrightnessSettings& settings);

/// The settings with gain and scale as the pairs of every second row show them: the median of the
/// ratios, and 1.4826 times the median magnitude of the residuals that it leaves.
BrightnessSettings adapted(const BrightnessSettings& settings, const SeenBrightness& observed,
                           const SeenBrightness& model, const Pose& model_from_observed);

}  // namespace inlay
