// Differential compositing: photograph and simulation become one picture (Mehta 2015, eq. 6.2).
#pragma once

#include "composite/blend/photo.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "render/trace/layers.h"

#include <cstdint>

namespace inlay {

/// How the change of irradiance reaches the photograph.
enum class BlendForm {
    ratio,    // L_cam E_RV / E_R, bounded: right for any diffuse surface
    additive  // L_cam + k / pi (E_RV - E_R), k <= 1: bounded where hardly any light was recorded
};

struct BlendSettings {
    BlendForm form = BlendForm::ratio;
    float epsilon_share = 1e-3f;  // of the mean E_R over the pixels where it changes, added to both
                                  // sides of the ratio; > 0
    float max_ratio = 4.0f;       // the ratio's upper bound, >= 1
};

/// Throws Error (usage) when a setting is out of its range.
void validate(const BlendSettings& settings);

struct Composite {
    Image<EncodedRgb> display;            // recorded bytes where nothing changed; at the
                                          // photograph's exposure elsewhere
    Image<Rgb> linear;                    // relative radiance at the reference exposure, >= 0
    std::uint64_t virtual_pixels = 0;     // M < 1
    std::uint64_t influenced_pixels = 0;  // display bytes that differ from the recorded ones
    std::uint64_t replaced_pixels = 0;    // a term was not finite: the photograph stands in
};

/// Mehta 2015, eq. 6.2, per channel, with E = direct + indirect:
///   L = (1 - M) (k_V E_RV_virtual + S_RV) + M L_cam E_RV_real / E_R.
/// Differs: the three irradiances are means over their own samples (as printed, a silhouette pixel
/// mixes them up), and the ratio is bounded (see bounded_ratio). Where E_R equals E_RV_real to the
/// bit the ratio is exactly 1, holes of the real geometry included; a pixel with M = 1 and such a
/// ratio keeps its recorded bytes. A layer that is an empty image counts as zero, but `m` must be
/// there. Throws Error (bad_data) when a layer's size is not the photograph's.
Composite composite(const Photo& photo, const Layers& layers, const BlendSettings& settings = {});

/// E_RV / E_R of one channel, kept finite: exactly 1 for equal irradiances, otherwise
/// (e_rv + epsilon) / (e_r + epsilon) clamped to 0..max_ratio.
double bounded_ratio(double e_r, double e_rv, double epsilon, double max_ratio);

/// L_cam + k / pi (E_RV - E_R) of one channel with the reflectance estimate
/// k = min(pi L_cam / E_R, 1). Never negative, since k E_R / pi <= L_cam.
double additive_change(double camera, double e_r, double e_rv);

}  // namespace inlay
