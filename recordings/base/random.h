// Random numbers as a function of (seed, frame, pixel, sample, dimension): threads and order do not
// matter, and both modes of the tracer may ask for the same number.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace inlay {

struct SampleKey {
    std::uint32_t seed = 1, frame = 0, pixel = 0, sample = 0;
};

/// Mixes the bits of a 32-bit word (Wellons's "lowbias32" constants, 2018).
inline std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

inline std::uint32_t hash(std::uint32_t a, std::uint32_t b) {
    return hash(a ^ (hash(b) + 0x9e3779b9U));
}

/// An independent uniform number in [0, 1).
inline float uniform(const SampleKey& k, std::uint32_t dimension) {
    const std::uint32_t bits =
        hash(hash(hash(hash(hash(k.seed), k.frame), k.pixel), k.sample), dimension);
    return float(bits >> 8) * 0x1p-24f;
}

/// Points of the unit square, one for each index 0, 1, 2, ..., of which every run from the start is
/// well spread: the first two Sobol dimensions, Owen-scrambled by hashing (Laine and Karras 2011;
/// Burley 2020).
struct StratifiedSet {
    std::uint32_t order = 0, scramble_x = 0, scramble_y = 0;  // seeds

    glm::vec2 at(std::uint32_t index) const;
};

/// The set of a pixel (`k.sample` is not used); different values of `dimension` give independent
/// ones.
StratifiedSet stratified_set(const SampleKey& k, std::uint32_t dimension);

/// Point `k.sample` of its pixel's set.
glm::vec2 stratified_pair(const SampleKey& k, std::uint32_t dimension);

}  // namespace inlay
