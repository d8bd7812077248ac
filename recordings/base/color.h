// Encoded (sRGB bytes) and linear color kept apart.
#pragma once

#include "recordings/base/image.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>

namespace inlay {

/// Linear, Rec. 709 primaries. Radiance is relative: 1 = what the camera encodes as full white.
using Rgb = glm::vec3;

/// 8-bit sRGB as in image files, red first.
struct EncodedRgb {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const EncodedRgb&) const = default;
};

/// Inverse of the sRGB transfer curve (IEC 61966-2-1), 0..1 for each channel.
Rgb decode(EncodedRgb encoded);

/// The sRGB transfer curve, rounded to the nearest byte; clamps to 0..1, NaN becomes 0.
/// encode(decode(x)) == x for every byte.
EncodedRgb encode(const Rgb& linear);
/// The same for many pixels, which is faster; `encoded` is as long as `linear`.
void encode(std::span<const Rgb> linear, std::span<EncodedRgb> encoded);

/// Byte from which on a channel of a photograph may have been brighter than it says.
constexpr int clipped_byte = 250;

/// Decodes every pixel and divides it by `exposure` (> 0).
Image<Rgb> decode(const Image<EncodedRgb>& encoded, const Rgb& exposure = Rgb(1));
Image<EncodedRgb> encode(const Image<Rgb>& linear);

/// Rec. 709 luminance.
inline float luminance(const Rgb& c) { return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b; }

}  // namespace inlay
