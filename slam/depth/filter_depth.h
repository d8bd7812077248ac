// One depth image, cleaned: what cannot be trusted becomes a hole, the rest is smoothed within
// surfaces.
#pragma once

#include "recordings/base/image.h"

namespace inlay {

struct DepthSettings {
    float nearest = 0.15f;         // m, nearer measurements are dropped
    float farthest = 5.0f;         // m, farther ones too
    float step = 6.0f;             // standard deviations of depth between which there is an edge
    float sensor_noise = 1.0f;     // factor on the standard deviation that depth_sigma() gives
    float steepest = 0.03f;        // share of depth by which a surface may recede per pixel
    int smoothing_radius = 3;      // px, half-width of the bilateral window; 0: no smoothing
    float smoothing_sigma = 2.0f;  // px, its spatial standard deviation
};

/// Throws Error that names the setting which is out of range.
void validate(const DepthSettings& settings);

/// Standard deviation (m) of a structured-light camera's z-depth at `z` (m): 1.2 mm at 0.4 m,
/// growing with the square of the distance. Nguyen, Izadi and Lovell 2012, eq. 6 (axial noise).
template <class Number>  // float, or several at a time
Number depth_sigma(Number z) {
    return 0.0012f + 0.0019f * (z - 0.4f) * (z - 0.4f);
}

/// Depth difference (m) at `z` (m) beyond which two neighbouring pixels see different surfaces.
template <class Number>
Number depth_step(Number z, const DepthSettings& settings) {
    return settings.step * settings.sensor_noise * depth_sigma(z);
}

/// The depth (m) with holes (0) where it is not finite, out of range, or of a flying pixel: one
/// that hangs between two surfaces, with no more than two of its 8 neighbours on its own, and is
/// not of a patch of such pixels that lie on one plane: that is a surface seen at a grazing angle.
Image<float> clean_depth(const Image<float>& depth, const DepthSettings& settings);

/// Bilateral filter of a cleaned depth image. Neighbours beyond a depth step have no weight at
/// all, and holes stay holes. Tomasi and Manduchi 1998, eq. 3.
Image<float> smooth_depth(const Image<float>& clean, const DepthSettings& settings);

/// clean_depth, then smooth_depth.
Image<float> filter_depth(const Image<float>& depth, const DepthSettings& settings);

}  // namespace inlay
