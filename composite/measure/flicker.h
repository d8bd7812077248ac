// Flicker: how much a picture's error changes from one frame to the next.
#pragma once

#include "composite/measure/image_error.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <cstdint>

namespace inlay {

/// A frame's picture C and its truth T, both linear. An empty truth stands for one that does not
/// change: that of a still camera.
struct ShownFrame {
    const Image<Rgb>& picture;
    const Image<Rgb>& truth;
};

/// Sums over pairs of consecutive frames; add_flicker fills them, flicker_of reads them.
struct FlickerSums {
    double change = 0;             // squared, of all channels
    std::uint64_t pixels = 0;      // compared, over all pairs
    std::uint64_t non_finite = 0;  // left out: not finite in one of the pictures
};

/// Root mean squares over the channels of the compared pixels of all pairs.
struct Flicker {
    double rms = 0;  // of (C_t - T_t) - (C_t-1 - T_t-1), linear radiance
    std::uint64_t pixels = 0;
    std::uint64_t non_finite = 0;
};

/// Adds the pixels that `mask` counts of two consecutive frames. An error that stays does not
/// flicker; white noise of variance s^2 gives an rms of s sqrt(2). Noise of the truths counts as
/// the picture's: with a still camera leave them empty. Throws Error (bad_data) when sizes differ,
/// pictures are empty, or only one of the frames has a truth.
void add_flicker(FlickerSums& sums, const ShownFrame& before, const ShownFrame& now,
                 const Mask& mask = {});

/// Throws Error (bad_data) when nothing was compared.
Flicker flicker_of(const FlickerSums& sums);
}  // namespace inlay
