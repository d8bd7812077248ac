// The tables of the transfer curve hold what its formula gives.
#include "recordings/base/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace inlay {
namespace {

/// IEC 61966-2-1, rounded.
int byte_of(float linear) {
    if (!(linear > 0)) return 0;
    const double v = std::min(double(linear), 1.0);
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return int(std::lround(s * 255.0));
}

int encoded(float linear) { return encode(Rgb(linear)).g; }

/// The least float that gives `byte`.
float first_of(int byte) {
    float below = 0, from = 1;
    while (std::nextafter(below, 2.0f) < from) {
        const auto middle = std::bit_cast<float>(
            (std::bit_cast<std::uint32_t>(below) + std::bit_cast<std::uint32_t>(from)) / 2);
        (byte_of(middle) >= byte ? from : below) = middle;
    }
    return from;
}

TEST(EncodeTable, EveryByteBeginsWhereTheFormulaSays) {
    for (int byte = 1; byte < 256; ++byte) {
        const float first = first_of(byte);
        EXPECT_EQ(encoded(first), byte);
        EXPECT_EQ(encoded(std::nextafter(first, 0.0f)), byte - 1);
    }
}

TEST(EncodeTable, AgreesWithTheFormulaAllOver) {
    const std::uint32_t end = std::bit_cast<std::uint32_t>(1.5f);
    for (std::uint32_t bits = 0; bits < end; bits += 997) {  // every octave, and the denormals
        const auto linear = std::bit_cast<float>(bits);
        ASSERT_EQ(encoded(linear), byte_of(linear)) << linear;
        ASSERT_EQ(encoded(-linear), 0) << linear;
    }
}

TEST(EncodeTable, TakesWhatIsNoColor) {
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(encoded(infinity), 255);
    EXPECT_EQ(encoded(-infinity), 0);
    EXPECT_EQ(encoded(std::numeric_limits<float>::max()), 255);
    EXPECT_EQ(encoded(std::numeric_limits<float>::quiet_NaN()), 0);
    EXPECT_EQ(encoded(std::numeric_limits<float>::denorm_min()), 0);
}

TEST(DecodeImage, IsEveryPixelDividedByTheExposure) {
    Image<EncodedRgb> bytes(16, 16);
    for (std::size_t i = 0; i < bytes.pixels.size(); ++i)
        bytes.pixels[i] = {std::uint8_t(i), std::uint8_t(255 - i), std::uint8_t(7 * i)};
    const Rgb exposure(0.7f, 1, 1.9f);
    const Image<Rgb> plain = decode(bytes), exposed = decode(bytes, exposure);
    for (std::size_t i = 0; i < bytes.pixels.size(); ++i) {
        EXPECT_EQ(plain.pixels[i], decode(bytes.pixels[i]));
        EXPECT_EQ(exposed.pixels[i], decode(bytes.pixels[i]) / exposure);
    }
    EXPECT_EQ(encode(plain).pixels, bytes.pixels);
}

}  // namespace
}  // namespace inlay
