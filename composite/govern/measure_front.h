// What samples cost on this machine and on this scene, from a frame that is sampled several times.
#pragma once

#include "composite/govern/price_front.h"
#include "composite/session/session.h"

#include <optional>

namespace inlay {

/// A frame that was composited, to be sampled again with other random numbers.
struct FrameAtHand {
    Session& session;
    const RgbdFrame& frame;
    const OutputFrame& out;
};

/// Whether virtual objects change a pixel of a frame that was composited.
bool shows_anything(const OutputFrame& out);

/// What the frame's samples took (ms, tracing and filtering); 0 where it also gathered light for
/// later frames, by more than a tenth of its rays: that is no price of samples.
double price_of_samples(const OutputFrame& out);

/// Samples the frame with 4 to 64 samples per pixel, one after the other, and estimates each
/// picture's error from two raw pictures (see estimate_error). Time and error are those of a frame
/// without the one before it. No point where nothing virtual shows in the frame; other_ms is left
/// 0.
PriceFront measure_front(const FrameAtHand& at_hand);

/// Error of the frame sampled anew, with as many samples as settings.trace has, over that of
/// `front` there. Nothing where nothing virtual shows, or the error is lost in noise.
std::optional<double> estimate_error_factor(const FrameAtHand& at_hand, const PriceFront& front);

}  // namespace inlay
