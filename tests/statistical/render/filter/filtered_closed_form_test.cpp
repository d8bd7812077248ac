// Traced samples before and after the filter against closed forms of irradiance: scenes whose light
// is the same at every point, so that smoothing must not change the mean.
#include "render/filter/environment_bandwidth.h"
#include "render/filter/filter_layers.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <numbers>

namespace inlay::test {
namespace {

constexpr double pi = std::numbers::pi;
constexpr std::uint32_t frames = 24;  // each with random numbers of its own
const Lens lens = lens_of(40, 30, 40);

/// The mean over the picture is one value per frame: pixels share samples once they are filtered,
/// frames do not.
struct FrameMeans {
    RunningMean noisy, filtered, with_previous;
};

/// The value of pixel i, taken from noisy or filtered layers alike; none outside the surface.
struct Quantity {
    std::function<double(const Irradiance& direct, const Irradiance& indirect, std::size_t i)>
        value;
    std::function<bool(const NoisyLayers&, std::size_t i)> counts;
    double variance_left;  // share of the noise's variance that the filter leaves at most
};

template <class AnyLayers>
RunningMean over_the_picture(const Quantity& quantity, const NoisyLayers& noisy,
                             const AnyLayers& layers) {
    RunningMean m;
    for (std::size_t i = 0; i < noisy.m.pixels.size(); ++i)
        if (quantity.counts(noisy, i)) m.add(quantity.value(layers.direct, layers.indirect, i));
    return m;
}

FrameMeans frame_means(const PlacedScene& scene, const EnvironmentSampler& sky, const Pose& view,
                       const Quantity& quantity) {
    const double b_e = environment_bandwidth(sky.map.radiance);
    const SamplingSettings sixteen = with_samples({}, 16);
    FrameMeans means;
    NoisyLayers before = sample_scene(scene, sky, lens, view, sixteen, frames).layers;
    for (std::uint32_t frame = 0; frame < frames; ++frame) {
        const NoisyLayers noisy = sample_scene(scene, sky, lens, view, sixteen, frame).layers;
        const RunningMean raw = over_the_picture(quantity, noisy, noisy);
        const RunningMean alone =
            over_the_picture(quantity, noisy, filter_layers(noisy, nullptr, b_e, {}));
        means.noisy.add(raw.mean);
        means.filtered.add(alone.mean);
        if (frame % 2 == 1)  // pairs of frames, so that these values are independent too
            means.with_previous.add(
                over_the_picture(quantity, noisy, filter_layers(noisy, &before, b_e, {})).mean);
        EXPECT_LT(alone.variance(), quantity.variance_left * raw.variance()) << "did it smooth?";
        before = noisy;
    }
    return means;
}

void expect_mean(const FrameMeans& means, double reference) {
    EXPECT_TRUE(has_mean(means.noisy, reference)) << "before the filter";
    EXPECT_TRUE(has_mean(means.filtered, reference)) << "after it";
    EXPECT_TRUE(has_mean(means.with_previous, reference)) << "with the frame before";
}

bool wholly_real(const NoisyLayers& noisy, std::size_t i) {
    return noisy.real.object.pixels[i] != 0 && noisy.virtual_.object.pixels[i] == 0;
}

/// On a plane kernels are as wide as their radius allows: a hundred pixels and more.
Quantity direct_on_real(Image<Rgb> Irradiance::*layer) {
    return {[layer](const Irradiance& direct, const Irradiance&, std::size_t i) {
                return double((direct.*layer).pixels[i].r);
            },
            wholly_real, 0.1};
}

PlacedScene real_scene(TriangleMesh mesh) {
    return PlacedScene({mesh_object(std::move(mesh), Diffuse{Rgb(0.5f)}, true)});
}

TEST(FilteredTwoModes, AnOpenPlaneUnderAConstantSkyReceivesPi) {
    const PlacedScene scene = real_scene(floor_mesh(20));
    const Pose view = look_at({1.5, 1, 0}, {0, 0, 0});
    for (const auto layer : {&Irradiance::e_r, &Irradiance::e_rv_real})
        expect_mean(frame_means(scene, constant_environment(1), view, direct_on_real(layer)), pi);
}

TEST(FilteredTwoModes, AHalfDomeGivesPiFromAboveAndHalfOfItFromTheSide) {
    const EnvironmentSampler sky = half_environment(1, 0);
    const Quantity e_r = direct_on_real(&Irradiance::e_r);
    expect_mean(frame_means(real_scene(floor_mesh(20)), sky, look_at({1.5, 1, 0}, {0, 0, 0}), e_r),
                pi);
    expect_mean(frame_means(real_scene(quad({-20, -20, 0}, {40, 0, 0}, {0, 40, 0})), sky,
                            look_at({0.5, 0.2, 1.5}, {0, 0, 0}), e_r),
                pi / 2);
}

/// Whatever the pixel's share of the sphere, every point of it receives pi. Its normals turn by ten
/// degrees within two or three pixels, which ends the kernels.
TEST(FilteredTwoModes, AConvexObjectInAFurnaceStaysAsWhiteAsItIs) {
    const PlacedScene scene({sphere_object({0, 0, 0}, 0.5f, Diffuse{Rgb(1)})});
    const Quantity radiance{
        [](const Irradiance& direct, const Irradiance& indirect, std::size_t i) {
            return double(direct.e_rv_virtual.pixels[i].r + indirect.e_rv_virtual.pixels[i].r) / pi;
        },
        [](const NoisyLayers& noisy, std::size_t i) {
            return noisy.virtual_.object.pixels[i] != 0;
        },
        0.5};
    expect_mean(
        frame_means(scene, constant_environment(1), look_at({0, 0, 1.5}, {0, 0, 0}), radiance), 1);
}

}  // namespace
}  // namespace inlay::test
