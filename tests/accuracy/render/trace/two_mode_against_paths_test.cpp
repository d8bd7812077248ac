// A real floor with a virtual sphere over it: the two-mode composite against path tracing of the
// same scene with the sphere really there.
#include "render/trace/picture.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace inlay::test {
namespace {

const Lens lens = lens_of(40, 30, 44);
const Pose view = look_at({0, 1, 1.6}, {0, 0.2, 0});
constexpr int frames = 32;  // of 16 samples
constexpr int paths = 512;

EnvironmentSampler lobe_light() {
    return environment_of(lobe_map(glm::normalize(glm::dvec3(1, 1.5, 0.6)), 8, 0.3f, Rgb(3)));
}

void add(Image<Rgb>& sum, const Image<Rgb>& more) {
    for (std::size_t i = 0; i < sum.pixels.size(); ++i)
        sum.pixels[i] += more.pixels[i] / float(frames);
}

/// Means over all frames of what eq. 6.2 combines, direct and indirect added.
struct MeanLayers {
    Image<Rgb> e_r, e_rv, on_virtual;  // on_virtual: k_V E_RV_virtual + S_RV
    Image<float> m;
};

MeanLayers mean_layers(const PlacedScene& scene, const EnvironmentSampler& light) {
    const Image<Rgb> zero(lens.width, lens.height, Rgb(0));
    MeanLayers mean{zero, zero, zero, Image<float>(lens.width, lens.height)};
    for (int frame = 0; frame < frames; ++frame) {
        NoisyLayers l = sample_scene(scene, light, lens, view, {}, std::uint32_t(frame)).layers;
        for (const Irradiance& e : {l.direct, l.indirect}) {
            add(mean.e_r, e.e_r);
            add(mean.e_rv, e.e_rv_real);
        }
        for (std::size_t i = 0; i < l.m.pixels.size(); ++i) {
            mean.m.pixels[i] += l.m.pixels[i] / float(frames);
            l.s_rv.pixels[i] += l.k_v.pixels[i] * (l.direct.e_rv_virtual.pixels[i] +
                                                   l.indirect.e_rv_virtual.pixels[i]);
        }
        add(mean.on_virtual, l.s_rv);
    }
    return mean;
}

/// Red; pixels that show both floor and sphere are left out.
struct Comparison {
    double floor_error, sphere_error;  // relative, of the region's mean; > 0: composite too bright
    double largest_floor_error;        // relative, of one floor pixel in size
};

Comparison compare(float floor_albedo, const Material& sphere) {
    const PlacedScene scene({mesh_object(floor_mesh(2), Diffuse{Rgb(floor_albedo)}, true),
                             sphere_object({0, 0.35, 0}, 0.3f, sphere)});
    const EnvironmentSampler light = lobe_light();
    const MeanLayers layers = mean_layers(scene, light);
    const Picture photo = trace_picture(scene.real, light, {lens, view}, paths);
    const Picture truth = trace_picture(scene.all, light, {lens, view, 2}, paths);
    double floor = 0, floor_truth = 0, on_sphere = 0, sphere_truth = 0, largest = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        const double expected = truth.radiance.pixels[i].r, m = layers.m.pixels[i];
        if (m == 0) {
            on_sphere += layers.on_virtual.pixels[i].r;
            sphere_truth += expected;
        } else if (m == 1 && layers.e_r.pixels[i].r > 0) {
            const double shown = double(photo.radiance.pixels[i].r) * layers.e_rv.pixels[i].r /
                                 layers.e_r.pixels[i].r;
            floor += shown;
            floor_truth += expected;
            if (expected > 0) largest = std::max(largest, std::abs(shown / expected - 1));
        }
    }
    const auto relative = [](double a, double b) { return b > 0 ? a / b - 1 : a; };
    return {relative(floor, floor_truth), relative(on_sphere, sphere_truth), largest};
}

/// Light meets floor and sphere at most once each here, so that the composite is the truth. 0.4 %:
/// the noise of 512 samples in each of some hundred pixels. 15 % in one pixel: four standard errors
/// of the darkest.
TEST(TwoModesAgainstPaths, AgreeWhereLightBouncesOnce) {
    const Comparison black_sphere = compare(0.6f, Diffuse{Rgb(0)});
    EXPECT_NEAR(black_sphere.floor_error, 0, 4e-3);
    EXPECT_LT(black_sphere.largest_floor_error, 0.15);
    for (const Material& material :
         {Material(Diffuse{Rgb(0.7f)}), Material(Phong{Rgb(0.2f), Rgb(0.6f), 30}),
          Material(Ggx{Rgb(0.9f), glm::vec2(0.5f), 0, nullptr})})
        EXPECT_NEAR(compare(0, material).sphere_error, 0, 4e-3);
}

/// What the approximation leaves out, by construction. On the floor: light that goes from the floor
/// to the sphere and back, since virtual surfaces met by indirect rays are lit by the environment
/// alone. It is albedo x albedo x coverage, so 0.6 x 0.7 x (0.3 / 0.35)^2 = 31 % of the open
/// floor's light at the point below the sphere, where little else arrives, and a few percent of the
/// mean. On the sphere: it sees the photographed floor, which lacks both the sphere's shadow (too
/// bright) and its bounce (too dark); the two nearly cancel.
TEST(TwoModesAgainstPaths, ErrByTheSecondBounceAndNoMore) {
    const Comparison c = compare(0.6f, Diffuse{Rgb(0.7f)});
    EXPECT_LT(c.floor_error, -5e-3);
    EXPECT_GT(c.floor_error, -0.05);
    EXPECT_LT(c.largest_floor_error, 0.5);
    EXPECT_NEAR(c.sphere_error, 0, 0.02);
}

}  // namespace
}  // namespace inlay::test
