#include "recordings/base/random.h"

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

std::uint32_t owen_scramble(std::uint32_t x, std::uint32_t seed) {
    return reverse_bits(permute_upwards(reverse_bits(x), seed));
}

/// Second dimension of the Sobol sequence (the first is the reversed index).
std::uint32_t sobol_second(std::uint32_t index) {
    std::uint32_t result = 0;
    for (std::uint32_t v = 1U << 31; index != 0; index >>= 1, v ^= v >> 1)
        if (index & 1U) result ^= v;
    return result;
}

float to_unit(std::uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

}  // namespace

glm::vec2 stratified_pair(const SampleKey& k, std::uint32_t dimension) {
    const std::uint32_t set = hash(hash(hash(hash(k.seed), k.frame), k.pixel), dimension);
    const std::uint32_t index = owen_scramble(k.sample, hash(set, 1));
    return {to_unit(owen_scramble(reverse_bits(index), hash(set, 2))),
            to_unit(owen_scramble(sobol_second(index), hash(set, 3)))};
}

}  // namespace inlay
