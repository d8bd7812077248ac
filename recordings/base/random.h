// Random numbers as a function of (seed, frame, pixel, sample, dimension): threads and order do not
// matter, and both modes of the tracer may ask for the same number.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace inlay {

struct SampleKey {
    std::uint32_t seed = 1, frame = 0, pixel = 0, sample = 0;
    std::uint32_t place = 0;  // of the pixel along a curve that keeps neighbors together
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

/// A random permutation of all words that keeps aligned blocks of 2^k together, whatever k: each
/// bit depends on the bits above it alone (Owen's nested scrambling by a hash: Laine and Karras
/// 2011; Burley 2020).
std::uint32_t shuffle_nested(std::uint32_t index, std::uint32_t seed);

/// Where a pixel (coordinates below 65536) lies along the Z-curve: the bits of both in turn (Morton
/// 1966). Aligned squares of 2^k x 2^k pixels lie together.
std::uint32_t place_along_curve(std::uint32_t x, std::uint32_t y);

/// Points of the unit square, one for each index 0, 1, 2, ..., of which every run from the start,
/// and every aligned run of 2^k, is well spread: the first two Sobol dimensions, Owen-scrambled by
/// hashing.
struct StratifiedSet {
    std::uint32_t order = 0, scramble_x = 0, scramble_y = 0;  // seeds
    std::uint32_t first = 0;                                  // index 0 of the run at hand

    glm::vec2 at(std::uint32_t index) const;
};

/// The set of a pixel (`k.sample` is not used); different values of `dimension` give independent
/// ones.
StratifiedSet stratified_set(const SampleKey& k, std::uint32_t dimension);

/// Point `k.sample` of its pixel's set.
glm::vec2 stratified_pair(const SampleKey& k, std::uint32_t dimension);

/// The one set that all pixels of a frame share (of `k`, only seed and frame are used).
StratifiedSet frame_set(const SampleKey& k, std::uint32_t dimension);

/// The run of a pixel at `place` (SampleKey::place) in its frame's set: `per_pixel` points, rounded
/// up to a power of two; beyond them the next pixel's follow, and beyond 2^32 in all the first ones
/// again. Runs follow each other along the Z-curve, so that the samples of neighbors are spread
/// together as well, and a filter takes more of their error away than of independent ones (Ahmed
/// and Wonka 2020).
StratifiedSet run_of(StratifiedSet frame_set, std::uint32_t place, int per_pixel);

}  // namespace inlay
