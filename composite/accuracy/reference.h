// Reference: what a composite should look like, how well that is known, and how far a picture is
// from it.
#pragma once

#include "composite/measure/image_error.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <optional>

namespace inlay {

/// A picture that judges others. Pixels that are not finite are left out of every figure.
struct Reference {
    Image<Rgb> linear;          // relative radiance
    Image<Rgb> standard_error;  // of `linear`, per pixel and channel
    Mask finite;                // pixels that can be compared
    Mask influenced;            // of these, the ones that virtual objects change
    std::size_t left_out = 0;   // pixels that are not finite
};

/// Judges by `linear`; a pixel counts as influenced where its luminance differs from `without`, the
/// same picture without virtual objects, by more than a viewer sees (0.004, a code value in the
/// middle greys) and six standard errors. All three images must have one size (Error).
Reference make_reference(Image<Rgb> linear, Image<Rgb> standard_error, const Image<Rgb>& without);

/// The mean of two independent estimates, with the standard error that their difference shows.
Reference mean_of_halves(const Image<Rgb>& a, const Image<Rgb>& b, const Image<Rgb>& without);

/// Figures of one frame. Mean squares have the reference's own variance taken out (at least 0).
struct FrameError {
    double mean_square = 0;             // of linear radiance, all pixels
    double mean_square_influenced = 0;  // over the influenced pixels
    double reference_power = 0;         // mean square of the reference, all pixels
    double psnr = 0;                    // dB; at most 100, which stands for equal pictures
    double ssim = 1, flip = 0;
    bool influenced = true;  // false: no pixel is; the second figure is then 0
};

/// Throws Error (bad_data) when sizes differ or no pixel can be compared.
FrameError error_against(const Reference& reference, const Image<Rgb>& linear,
                         const Image<EncodedRgb>& display);

/// Mean over the channels of the masked pixels of (a - picture)(b - picture): the mean square
/// distance of `picture` from what `a` and `b` are independent estimates of, whose noise drops out.
/// May be negative where there is nothing but noise; 0 for an empty mask. All must have one size
/// (Error).
double mean_square_beyond_noise(const Image<Rgb>& picture, const Image<Rgb>& a, const Image<Rgb>& b,
                                const Mask& mask);

/// The reference's variance, mean over the channels of its influenced pixels; 0 without any.
double influenced_variance(const Reference& reference);

/// RMS of the reference's standard error over its influenced pixels; 0 where there are none.
double influenced_standard_error(const Reference& reference);

}  // namespace inlay
