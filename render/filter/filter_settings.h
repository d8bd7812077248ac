// FilterSettings: every choice of the environment filter, with its unit and default.
#pragma once

namespace inlay {

/// Which bandwidths and widths the filter uses: those of Mehta 2015, ch. 6, as printed, or with its
/// constants corrected (see bandlimits.h), or that of Durand et al. 2005 in its place.
enum class FilterConstants { corrected, thesis, durand };

struct FilterSettings {
    bool enabled = true;  // false: the noisy values are passed on
    FilterConstants constants = FilterConstants::corrected;
    bool real_curvature = true;      // false: a real surface's curvature does not narrow the filter
    double curvature_safety = 0.2;   // s_k, > 0; the smaller, the sharper on curved surfaces
    double visibility_safety = 1.0;  // s_v, > 0; the smaller, the sharper next to occluders
    int rate_reach = 2;              // px, >= 0; see filled_rates; with corrected constants alone
    int kernel_radius = 15;          // px, >= 0, each way along a row and a column
    double narrowest_width = 1.0;    // px, >= 0; lower bound of sigma; beyond 16 samples it shrinks
                                     // with them, but not where both modes share their noise
    double narrowest_change = 0.6;   // px, >= 0; the same, at 16 samples, for a change sampled for
                                     // itself, which is less noisy; it follows the samples
    double normal_stop_deg = 10.0;   // 0..90, exclusive; surfaces that turn further do not mix
    bool temporal = true;            // use the previous frame's unfiltered values; of a change that
                                     // was sampled for itself alone, and not of E_R beside it
    double rejection_distance = 3.0;  // px, > 0; last frame's surface must lie within
};

/// Throws Error(usage) that names the setting which is out of its range.
void validate(const FilterSettings& settings);

}  // namespace inlay
