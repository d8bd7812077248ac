#include "recordings/base/random.h"

#include <bit>

namespace inlay {
namespace {

std::uint32_t reverse_bits(std::uint32_t x) {
    x = ((x >> 1) & 0x55555555U) | ((x & 0x55555555U) << 1);
    x = ((x >> 2) & 0x33333333U) | ((x & 0x33333333U) << 2);
    x = ((x >> 4) & 0x0f0f0f0fU) | ((x & 0x0f0f0f0fU) << 4);
    return __builtin_bswap32(x);
}

/// A random permutation in which each bit depends only on the bits below it (Laine and Karras 2011,
/// with Burley's 2020 constants): on reversed bits this is Owen's nested scrambling.
std::uint32_t permute_upwards(std::uint32_t x, std::uint32_t seed) {
    x ^= x * 0x3d20adeaU;
    x += seed;
    x *= (seed >> 16) | 1U;
    x ^= x * 0x05526c56U;
    x ^= x * 0x53a22864U;
    return x;
}

/// The second dimension of the Sobol sequence (the first is the reversed index), bits reversed: bit
/// j is the sum, modulo 2, of the index's bits i with i choose j odd, which are those that contain
/// j's bits (Lucas).
std::uint32_t reversed_sobol_second(std::uint32_t x) {
    x ^= (x >> 1) & 0x55555555U;
    x ^= (x >> 2) & 0x33333333U;
    x ^= (x >> 4) & 0x0f0f0f0fU;
    x ^= (x >> 8) & 0x00ff00ffU;
    return x ^ (x >> 16);
}

float to_unit(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

/// The bits of a 16-bit number, each followed by a 0.
std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | (x << 8)) & 0x00ff00ffU;
    x = (x | (x << 4)) & 0x0f0f0f0fU;
    x = (x | (x << 2)) & 0x33333333U;
    return (x | (x << 1)) & 0x55555555U;
}

}  // namespace

std::uint32_t shuffle_nested(std::uint32_t index, std::uint32_t seed) {
    return reverse_bits(permute_upwards(reverse_bits(index), seed));
}

std::uint32_t place_along_curve(std::uint32_t x, std::uint32_t y) {
    return spread_bits(x) | (spread_bits(y) << 1);
}

StratifiedSet stratified_set(const SampleKey& k, std::uint32_t dimension) {
    const std::uint32_t set = hash(hash(hash(hash(k.seed), k.frame), k.pixel), dimension);
    return {hash(set, 1), hash(set, 2), hash(set, 3), 0};
}

glm::vec2 StratifiedSet::at(std::uint32_t index) const {
    const std::uint32_t shuffled = shuffle_nested(first + index, order);
    return {to_unit(reverse_bits(permute_upwards(shuffled, scramble_x))),
            to_unit(reverse_bits(permute_upwards(reversed_sobol_second(shuffled), scramble_y)))};
}

glm::vec2 stratified_pair(const SampleKey& k, std::uint32_t dimension) {
    return stratified_set(k, dimension).at(k.sample);
}

StratifiedSet frame_set(const SampleKey& k, std::uint32_t dimension) {
    return stratified_set({k.seed, k.frame, 0, 0, 0}, dimension);
}

StratifiedSet run_of(StratifiedSet frame_set, std::uint32_t place, int per_pixel) {
    frame_set.first = place * std::bit_ceil(std::uint32_t(per_pixel));
    return frame_set;
}

}  // namespace inlay
