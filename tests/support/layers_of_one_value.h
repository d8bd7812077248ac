// Layers and photographs whose pixels are all alike, for tests of compositing.
#pragma once

#include "composite/blend/photo.h"
#include "render/trace/layers.h"

#include <cstdint>

namespace inlay::test {

/// A photograph of one grey.
inline Photo grey_photo(int width, int height, std::uint8_t grey) {
    return linearise(Image<EncodedRgb>(width, height, {grey, grey, grey}));
}

/// What a pixel without virtual objects has: M = 1 and the same irradiance in both modes.
inline Layers untouched_layers(int width, int height, float irradiance) {
    const Image<Rgb> zero(width, height, Rgb(0));
    const Image<Rgb> real(width, height, Rgb(irradiance));
    Layers layers;
    layers.m = Image<float>(width, height, 1.0f);
    layers.k_v = zero;
    layers.s_rv = zero;
    layers.direct = {real, real, zero};
    layers.indirect = {zero, zero, zero};
    return layers;
}

}  // namespace inlay::test
