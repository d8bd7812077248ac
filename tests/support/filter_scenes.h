// Noisy layers of simple surfaces seen from far above, for tests of the filter.
#pragma once

#include "recordings/base/random.h"
#include "render/trace/layers.h"

#include <cmath>
#include <cstring>

namespace inlay::test {

constexpr double camera_height = 1000;  // m: rays are parallel to 1e-3 over the scenes used here

/// Layers that hold nothing, seen from high above the world's origin (z up) with `spacing` (m)
/// between pixels at z = 0; the world's x runs right and its y up in the image.
inline NoisyLayers layers_from_above(int width, int height, double spacing, int samples = 16) {
    const Image<Rgb> black(width, height, Rgb(0));
    const Image<glm::vec3> vectors(width, height, glm::vec3(0));
    const Image<float> numbers(width, height, 0.0f);
    const Receiver nothing{Image<std::uint32_t>(width, height, 0), vectors, vectors, numbers,
                           numbers};
    const Irradiance dark{black, black, black};
    const double f = camera_height / spacing;
    NoisyLayers layers;
    layers.lens = {width, height, f, f, 0.5 * (width - 1), 0.5 * (height - 1)};
    layers.world_from_camera = {
        glm::dmat3(glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::dvec3(0, 0, -1)),
        glm::dvec3(0, 0, camera_height)};
    layers.samples = samples;
    layers.m = layers.glossy_bandwidth = numbers;
    layers.k_v = layers.s_rv = black;
    layers.direct = layers.indirect = dark;
    layers.real = layers.virtual_ = nothing;
    return layers;
}

/// World x and y of a pixel.
inline glm::dvec2 ground_of(const NoisyLayers& layers, int x, int y) {
    const double spacing = camera_height / layers.lens.fx;
    return {(x - layers.lens.cx) * spacing, (layers.lens.cy - y) * spacing};
}

/// Independent uniform colors in 0..1.
inline Rgb random_rgb(std::uint32_t seed, std::uint32_t pixel) {
    const SampleKey key{seed, 0, pixel, 0};
    return {uniform(key, 0), uniform(key, 1), uniform(key, 2)};
}

/// A horizontal real plane that covers the image; every irradiance on it is noise in 0..1.
inline NoisyLayers noisy_plane(int width, int height, double spacing, std::uint32_t seed) {
    NoisyLayers layers = layers_from_above(width, height, spacing);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            layers.real.object(x, y) = 1;
            layers.real.position(x, y) = glm::vec3(glm::dvec3(ground_of(layers, x, y), 0));
            layers.real.normal(x, y) = {0, 0, 1};
            layers.m(x, y) = 1;
            const auto pixel = std::uint32_t(layers.m.index(x, y));
            layers.direct.e_r(x, y) = random_rgb(seed, pixel);
            layers.direct.e_rv_real(x, y) = random_rgb(seed + 1, pixel);
            layers.indirect.e_r(x, y) = random_rgb(seed + 2, pixel);
            layers.indirect.e_rv_real(x, y) = random_rgb(seed + 3, pixel);
        }
    }
    return layers;
}

/// Puts a virtual ball over the middle of a plane's image, with noise on it.
inline void add_ball(NoisyLayers& layers, double radius, std::uint32_t seed) {
    for (int y = 0; y < layers.lens.height; ++y) {
        for (int x = 0; x < layers.lens.width; ++x) {
            const glm::dvec2 off = ground_of(layers, x, y) / radius;
            if (glm::dot(off, off) >= 1) continue;
            const glm::dvec3 n(off, std::sqrt(1 - glm::dot(off, off)));
            layers.virtual_.object(x, y) = 1;
            layers.virtual_.position(x, y) = glm::vec3(radius * n);
            layers.virtual_.normal(x, y) = glm::vec3(n);
            layers.glossy_bandwidth(x, y) = 14.6f;
            layers.m(x, y) = 0;
            const auto pixel = std::uint32_t(layers.m.index(x, y));
            layers.direct.e_rv_virtual(x, y) = random_rgb(seed, pixel);
            layers.indirect.e_rv_virtual(x, y) = random_rgb(seed + 1, pixel);
            layers.s_rv(x, y) = random_rgb(seed + 2, pixel);
        }
    }
}

template <class Pixel>
bool same_bits(const Image<Pixel>& a, const Image<Pixel>& b) {
    return same_size(a, b) &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Pixel)) == 0;
}

inline bool same_bits(const Irradiance& a, const Irradiance& b) {
    return same_bits(a.e_r, b.e_r) && same_bits(a.e_rv_real, b.e_rv_real) &&
           same_bits(a.e_rv_virtual, b.e_rv_virtual);
}

inline bool same_bits(const Layers& a, const Layers& b) {
    return same_bits(a.m, b.m) && same_bits(a.k_v, b.k_v) && same_bits(a.s_rv, b.s_rv) &&
           same_bits(a.direct, b.direct) && same_bits(a.indirect, b.indirect) &&
           same_bits(a.bandwidth_direct, b.bandwidth_direct) &&
           same_bits(a.bandwidth_indirect, b.bandwidth_indirect);
}

}  // namespace inlay::test
