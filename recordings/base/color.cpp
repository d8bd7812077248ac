#include "recordings/base/color.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace inlay {
namespace {

float decode_channel(int byte) {
    const double v = byte / 255.0;
    return float(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4));
}

const std::array<float, 256>& decoded_bytes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> t{};
        for (int i = 0; i < 256; ++i)
            t[std::size_t(i)] = decode_channel(i);
        return t;
    }();
    return table;
}

std::uint8_t encode_channel(float linear) {
    if (!(linear > 0)) return 0;  // also NaN
    const double v = std::min(double(linear), 1.0);
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return std::uint8_t(std::lround(s * 255.0));
}

}  // namespace

Rgb decode(EncodedRgb encoded) {
    const auto& table = decoded_bytes();
    return {table[encoded.r], table[encoded.g], table[encoded.b]};
}

EncodedRgb encode(const Rgb& linear) {
    return {encode_channel(linear.r), encode_channel(linear.g), encode_channel(linear.b)};
}

Image<Rgb> decode(const Image<EncodedRgb>& encoded) {
    Image<Rgb> linear(encoded.width, encoded.height);
    for (std::size_t i = 0; i < encoded.pixels.size(); ++i)
        linear.pixels[i] = decode(encoded.pixels[i]);
    return linear;
}

Image<EncodedRgb> encode(const Image<Rgb>& linear) {
    Image<EncodedRgb> encoded(linear.width, linear.height);
    for (std::size_t i = 0; i < linear.pixels.size(); ++i)
        encoded.pixels[i] = encode(linear.pixels[i]);
    return encoded;
}

}  // namespace inlay
