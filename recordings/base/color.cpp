#include "recordings/base/color.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

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

/// By the formula; for numbers from 0.
int exact_byte(float linear) {
    const double v = std::min(double(linear), 1.0);
    const double s = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return int(std::lround(s * 255.0));
}

constexpr float dark = 0x1p-13f;  // smaller numbers give the byte 0
constexpr int cell_bits = 16;     // of a float, that its cell leaves out
constexpr std::uint32_t first_cell = std::bit_cast<std::uint32_t>(dark) >> cell_bits;
constexpr std::uint32_t cells = (std::bit_cast<std::uint32_t>(1.0f) >> cell_bits) - first_cell;

/// Where the bytes change. Numbers fall into cells by their exponent and first seven bits, which
/// are so narrow that the byte changes at most once in each.
struct EncoderTable {
    std::array<float, 256> next_from{};         // the least number that gives more than the byte
    std::array<std::uint8_t, cells> byte_at{};  // at the beginning of each cell
};

/// The least float that gives more than `byte`; floats above 0 are ordered as their bits are.
float next_from(int byte) {
    auto low = std::bit_cast<std::uint32_t>(0.0f), high = std::bit_cast<std::uint32_t>(1.0f);
    while (high - low > 1) {
        const std::uint32_t middle = (low + high) / 2;
        (exact_byte(std::bit_cast<float>(middle)) > byte ? high : low) = middle;
    }
    return std::bit_cast<float>(high);
}

EncoderTable make_encoder() {
    EncoderTable table;
    table.next_from.fill(std::numeric_limits<float>::infinity());
    for (int byte = 0; byte < 255; ++byte)  // nothing gives more than 255
        table.next_from[std::size_t(byte)] = next_from(byte);
    for (std::size_t i = 0; i < table.byte_at.size(); ++i) {
        const std::uint32_t bits = (first_cell + std::uint32_t(i)) << cell_bits;
        table.byte_at[i] = std::uint8_t(exact_byte(std::bit_cast<float>(bits)));
    }
    return table;
}

const EncoderTable& encoder() {
    static const EncoderTable table = make_encoder();
    return table;
}

std::uint8_t encode_channel(const EncoderTable& table, float linear) {
    if (!(linear >= dark)) return 0;  // also NaN
    if (linear >= 1) return 255;
    const std::uint32_t cell = (std::bit_cast<std::uint32_t>(linear) >> cell_bits) - first_cell;
    const std::uint8_t byte = table.byte_at[cell];
    return std::uint8_t(byte + (linear >= table.next_from[byte] ? 1 : 0));
}

}  // namespace

Rgb decode(EncodedRgb encoded) {
    const auto& table = decoded_bytes();
    return {table[encoded.r], table[encoded.g], table[encoded.b]};
}

EncodedRgb encode(const Rgb& linear) {
    const EncoderTable& table = encoder();
    return {encode_channel(table, linear.r), encode_channel(table, linear.g),
            encode_channel(table, linear.b)};
}

void encode(std::span<const Rgb> linear, std::span<EncodedRgb> encoded) {
    const EncoderTable& table = encoder();
    for (std::size_t i = 0; i < linear.size(); ++i) {
        const Rgb& from = linear[i];
        encoded[i] = {encode_channel(table, from.r), encode_channel(table, from.g),
                      encode_channel(table, from.b)};
    }
}

Image<Rgb> decode(const Image<EncodedRgb>& encoded, const Rgb& exposure) {
    std::array<Rgb, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = decoded_bytes()[i] / exposure;
    Image<Rgb> linear(encoded.width, encoded.height);
    parallel_rows(encoded.height, [&](int y) {
        const std::span<const EncodedRgb> from = encoded.row(y);
        const std::span<Rgb> to = linear.row(y);
        for (std::size_t x = 0; x < to.size(); ++x)
            to[x] = {table[from[x].r].r, table[from[x].g].g, table[from[x].b].b};
    });
    return linear;
}

Image<EncodedRgb> encode(const Image<Rgb>& linear) {
    Image<EncodedRgb> encoded(linear.width, linear.height);
    parallel_rows(linear.height, [&](int y) { encode(linear.row(y), encoded.row(y)); });
    return encoded;
}

}  // namespace inlay
