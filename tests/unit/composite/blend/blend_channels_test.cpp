// The composite of all channels at once is that of each channel alone, to the bit.
#include "composite/blend/differential.h"
#include "recordings/base/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

Image<Rgb> any_colors(std::uint32_t seed, float scale) {
    Image<Rgb> image(16, 12);
    for (std::uint32_t i = 0; i < image.pixels.size(); ++i) {
        const SampleKey key{seed, 0, i, 0};
        image.pixels[i] = scale * Rgb(uniform(key, 0), uniform(key, 1), uniform(key, 2));
    }
    return image;
}

double sum(const Image<Rgb>& direct, const Image<Rgb>& indirect, std::size_t i, int c) {
    return double(direct.pixels[i][c]) + double(indirect.pixels[i][c]);
}

TEST(Composite, ChannelsAreBlendedAlike) {
    const Image<Rgb> camera = any_colors(1, 1);
    const Photo photo{encode(camera), camera};
    Layers layers;
    layers.m = Image<float>(16, 12);
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i)
        layers.m.pixels[i] = float(i % 5) / 4;
    layers.k_v = any_colors(2, 0.3f), layers.s_rv = any_colors(3, 0.2f);
    layers.direct = {any_colors(4, 2), any_colors(5, 2), any_colors(6, 2)};
    layers.indirect = {any_colors(7, 1), any_colors(8, 1), any_colors(9, 1)};
    const BlendSettings settings{.form = BlendForm::additive};  // without a mean over the picture
    const Composite result = composite(photo, layers, settings);
    for (std::size_t i = 0; i < camera.pixels.size(); ++i) {
        const double m = double(layers.m.pixels[i]);
        for (int c = 0; c < 3; ++c) {
            const Irradiance &d = layers.direct, &n = layers.indirect;
            const double real =
                additive_change(double(camera.pixels[i][c]), sum(d.e_r, n.e_r, i, c),
                                sum(d.e_rv_real, n.e_rv_real, i, c));
            const double virtual_part =
                double(layers.k_v.pixels[i][c]) * sum(d.e_rv_virtual, n.e_rv_virtual, i, c) +
                double(layers.s_rv.pixels[i][c]);
            EXPECT_EQ(result.linear.pixels[i][c], float((1 - m) * virtual_part + m * real));
        }
        EXPECT_EQ(result.display.pixels[i], encode(result.linear.pixels[i]));
    }
}

}  // namespace
}  // namespace inlay
