// How far one picture is from another: in linear radiance, and as a viewer sees it.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <cstdint>

namespace inlay {

/// Which pixels count: those that are not 0. An empty mask counts all.
using Mask = Image<std::uint8_t>;

/// Differences of linear radiance over the channels of the counted pixels.
struct RadianceError {
    double rmse = 0;           // root mean square
    double relative_rmse = 0;  // rmse / root mean square of the reference; infinite when that is 0
    std::uint64_t pixels = 0;  // compared
    std::uint64_t non_finite = 0;  // left out: not finite in one of the two
};

/// Differences of the display image.
struct DisplayError {
    double psnr = 0;  // dB; infinite for equal pictures
    double ssim = 1;  // -1..1, 1 = equal
    double flip = 0;  // 0..1, 0 = equal
};

struct FlipSettings {
    double pixels_per_degree = 67;  // of visual angle: a 0.7 m wide 4K monitor seen from 0.7 m
};

/// All functions throw Error (bad_data) when sizes differ or nothing is counted.
RadianceError radiance_error(const Image<Rgb>& image, const Image<Rgb>& reference,
                             const Mask& mask = {});

/// 10 log10(255^2 / mean squared difference of the bytes), dB.
double psnr(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
            const Mask& mask = {});

/// Mean of ssim_map over the counted pixels.
double ssim(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
            const Mask& mask = {});

/// Structural similarity of the encoded luminance, per pixel, with Gaussian windows of 11 x 11 px,
/// sigma 1.5 px (Wang et al. 2004, eq. 13-16). Differs: windows are cut at the border and
/// renormalised, so that every pixel has a value.
Image<float> ssim_map(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference);

/// Mean of flip_map over the counted pixels.
double flip(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
            const Mask& mask = {}, const FlipSettings& settings = {});

/// LDR-FLIP per pixel, 0..1: the difference seen when the two pictures alternate (Andersson et al.
/// 2020, HPG, sec. 4 and 5, with its constants).
Image<float> flip_map(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
                      const FlipSettings& settings = {});

/// The three display figures at once.
DisplayError display_error(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
                           const Mask& mask = {});

}  // namespace inlay
