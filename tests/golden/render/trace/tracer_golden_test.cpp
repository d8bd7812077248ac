// One still life, path-traced and sampled in two modes, against references of 16384 samples.
#include "render/trace/picture.h"
#include "tests/support/golden_image.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace inlay::test {
namespace {

const Lens lens = lens_of(40, 30, 44);
const Pose view = look_at({0.3, 1.2, 2.2}, {0.05, 0.25, 0});

std::vector<SceneObject> still_life() {
    SceneObject box = mesh_object(cube_mesh(0.25f), Diffuse{Rgb(0.8f, 0.3f, 0.2f)}, true);
    box.motion[0].world_from_object[3] = {-0.6, 0.25, -0.1, 1};
    return {mesh_object(floor_mesh(2), Diffuse{Rgb(0.6f)}, true), box,
            sphere_object({-0.1, 0.2, 0.4}, 0.2f, Diffuse{Rgb(0.2f, 0.6f, 0.8f)}),
            sphere_object({0.3, 0.3, -0.2}, 0.3f, Phong{Rgb(0.1f), Rgb(0.8f), 40}),
            sphere_object({0.75, 0.22, 0.3}, 0.22f,
                          Ggx{Rgb(0.9f, 0.7f, 0.3f), glm::vec2(0.45f), 1, nullptr})};
}

EnvironmentSampler studio() {
    return environment_of(lobe_map(glm::normalize(glm::dvec3(1, 1.5, 1)), 12, 0.3f, Rgb(3)));
}

GoldenImage by_paths(int samples, std::uint32_t seed) {
    const PlacedScene scene(still_life());
    const Picture picture = trace_picture(scene.all, studio(), {lens, view, seed}, samples);
    GoldenImage result{picture.radiance, picture.standard_error};
    for (Rgb& c : result.variance.pixels)
        c = c * c * float(samples);
    return result;
}

/// Radiance of a pixel if real surfaces were white: every layer takes part, and linearly.
Rgb combined(const NoisyLayers& l, std::size_t i) {
    const Rgb on_real = l.direct.e_rv_real.pixels[i] + l.indirect.e_rv_real.pixels[i];
    const Rgb on_virtual = l.direct.e_rv_virtual.pixels[i] + l.indirect.e_rv_virtual.pixels[i];
    const float m = l.m.pixels[i];
    return (1 - m) * (l.k_v.pixels[i] * on_virtual + l.s_rv.pixels[i]) +
           m * on_real * std::numbers::inv_pi_v<float>;
}

/// Frames of 16 samples each.
GoldenImage by_two_modes(int samples, std::uint32_t seed) {
    const PlacedScene scene(still_life());
    const EnvironmentSampler light = studio();
    Image<glm::dvec3> sum(lens.width, lens.height, glm::dvec3(0)), squares = sum;
    SamplingSettings settings;
    settings.seed = seed;
    const int frames = samples / 16;
    for (int frame = 0; frame < frames; ++frame) {
        const NoisyLayers layers =
            sample_scene(scene, light, lens, view, settings, std::uint32_t(frame)).layers;
        for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
            const glm::dvec3 value(combined(layers, i));
            sum.pixels[i] += value;
            squares.pixels[i] += value * value;
        }
    }
    GoldenImage result{Image<Rgb>(lens.width, lens.height), Image<Rgb>(lens.width, lens.height)};
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {
        const glm::dvec3 mean = sum.pixels[i] / double(frames);
        const glm::dvec3 spread = squares.pixels[i] / double(frames) - mean * mean;
        result.mean.pixels[i] = Rgb(mean);
        result.variance.pixels[i] = Rgb(16.0 * glm::max(spread, glm::dvec3(0)));
    }
    return result;
}

TEST(TracerGolden, Paths) { expect_golden("still_life_paths", by_paths, 128); }

TEST(TracerGolden, TwoModes) { expect_golden("still_life_two_modes", by_two_modes, 512); }

}  // namespace
}  // namespace inlay::test
