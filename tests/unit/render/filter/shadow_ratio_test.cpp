// Filtering the shadow ratio: unshadowed light from the sampler, and what becomes of it.
#include "recordings/base/check.h"
#include "recordings/environment/environment_tools.h"
#include "render/filter/filter_layers.h"
#include "tests/support/filter_scenes.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay::test {
namespace {

const Pose view = look_at({0, 1.5, 2}, {0, 0, 0});

EnvironmentSampler lobe_environment() {
    return environment_of(lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2)));
}

SamplingSettings with_unshadowed() {
    SamplingSettings settings;
    settings.unshadowed = true;
    return settings;
}

PlacedScene floor_and(const std::vector<SceneObject>& objects) {
    std::vector<SceneObject> all = objects;
    all.push_back(mesh_object(floor_mesh(30), Diffuse{Rgb(0.5f)}, true));
    return PlacedScene(all);
}

TEST(EnvironmentIrradiance, AgreesWithTheIntegralForAnyNormal) {
    for (const Image<Rgb>& map :
         {lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2)),
          make_lobes(Rgb(0.1f), {{{0, 1, 0}, 30, Rgb(9)}, {{0, -0.6, 0.8}, 5, Rgb(1)}})}) {
        EnvironmentMap environment{map, look_at({0, 0, 0}, {0.2, 0.9, 0.4}, {1, 0, 0}).rotation};
        const EnvironmentIrradiance irradiance = make_environment_irradiance(environment);
        double largest = 0;
        for (const Rgb& e : irradiance.by_normal.pixels)
            largest = std::max(largest, double(e.r));
        for (std::uint32_t i = 0; i < 12; ++i) {
            const glm::vec2 u = stratified_pair({1, 0, 0, i}, 0);
            glm::dvec3 n(glm::normalize(glm::vec3(u * 2.0f - 1.0f, std::cos(7 * u.x))));
            if (i == 0) n = {0, 1, 0};
            if (i == 1) n = {0, -1, 0};
            // The table's spacing h is 0.049 rad, and irradiance's second derivative is at most
            // about its largest value: h^2 / 8 twice is 6e-4 of it.
            EXPECT_NEAR(irradiance_on(irradiance, glm::vec3(n)).r,
                        irradiance_from_environment(environment, n).r, 2e-3 * largest);
        }
    }
}

TEST(EnvironmentIrradiance, OfAConstantMapIsPiTimesItsRadiance) {
    for (const auto& [width, height] : {std::pair{1, 1}, {7, 3}, {100, 50}, {300, 200}}) {
        const EnvironmentIrradiance irradiance =
            make_environment_irradiance({Image<Rgb>(width, height, Rgb(2)), glm::dmat3(1.0)});
        // Parcels that the horizon cuts count by their middle: some 1e-4.
        for (const Rgb& e : irradiance.by_normal.pixels)
            EXPECT_NEAR(e.r / (2 * M_PI), 1, 1e-3);
    }
}

TEST(Unshadowed, IsNotSampledUnlessAskedForAndChangesNothingElse) {
    const PlacedScene scene = floor_and({sphere_object({0.3, 0.2, 0}, 0.2f, Diffuse{Rgb(0.8f)})});
    const Lens lens = lens_of(20, 14, 20);
    NoisyLayers without = sample_scene(scene, lobe_environment(), lens, view, {}).layers;
    NoisyLayers with =
        sample_scene(scene, lobe_environment(), lens, view, with_unshadowed()).layers;
    EXPECT_TRUE(without.unshadowed.real.empty());
    EXPECT_TRUE(without.unshadowed.virtual_.empty());
    EXPECT_EQ(with.unshadowed.real.pixels.size(), with.m.pixels.size());
    EXPECT_TRUE(same_bytes(with, without));
}

TEST(Unshadowed, EqualsTheLightToTheBitWhereNothingShadows) {
    const PlacedScene open = floor_and({});
    const NoisyLayers layers =
        sample_scene(open, lobe_environment(), lens_of(20, 14, 20), view, with_unshadowed()).layers;
    EXPECT_TRUE(same_bits(layers.unshadowed.real, layers.direct.e_r));
    EXPECT_TRUE(same_bits(layers.unshadowed.real, layers.direct.e_rv_real));

    const PlacedScene lone({sphere_object({0, 0, 0}, 0.5f, Diffuse{Rgb(0.8f)})});
    const NoisyLayers sphere =
        sample_scene(lone, lobe_environment(), lens_of(20, 14, 20), view, with_unshadowed()).layers;
    EXPECT_TRUE(same_bits(sphere.unshadowed.virtual_, sphere.direct.e_rv_virtual));
}

TEST(Unshadowed, IsAtLeastTheShadowedLight) {
    const PlacedScene scene = floor_and({sphere_object({0.3, 0.2, 0}, 0.2f, Diffuse{Rgb(0.8f)})});
    const NoisyLayers layers =
        sample_scene(scene, lobe_environment(), lens_of(40, 30, 40), view, with_unshadowed())
            .layers;
    int shadowed = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        EXPECT_GE(layers.unshadowed.real.pixels[i].r, layers.direct.e_rv_real.pixels[i].r);
        EXPECT_GE(layers.unshadowed.virtual_.pixels[i].r, layers.direct.e_rv_virtual.pixels[i].r);
        shadowed += layers.unshadowed.real.pixels[i].r > layers.direct.e_rv_real.pixels[i].r;
    }
    EXPECT_GT(shadowed, 20);
}

TEST(ShadowRatio, GivesUnoccludedSurfacesTheirExactIrradiance) {
    const EnvironmentSampler light = lobe_environment();
    const EnvironmentIrradiance open_sky = make_environment_irradiance(light.map);
    const PlacedScene scene({sphere_object({0, 0, 0}, 0.5f, Diffuse{Rgb(0.8f)})});
    const NoisyLayers layers =
        sample_scene(scene, light, lens_of(40, 30, 40), view, with_unshadowed()).layers;
    const Layers smooth = filter_layers(layers, nullptr, 6, {}, &open_sky);
    int lit = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        if (layers.virtual_.object.pixels[i] == 0) continue;
        const Rgb e = smooth.direct.e_rv_virtual.pixels[i];
        if (e == Rgb(0)) continue;  // no sample of the kernel came from above the surface
        ++lit;
        const Rgb expected = irradiance_on(open_sky, layers.virtual_.normal.pixels[i]);
        for (int c = 0; c < 3; ++c)
            EXPECT_FLOAT_EQ(e[c], expected[c]);
    }
    EXPECT_GT(lit, 100);
}

TEST(ShadowRatio, StaysBetweenNothingAndTheOpenSkyAndLeavesEqualModesEqual) {
    const EnvironmentSampler light = lobe_environment();
    const EnvironmentIrradiance open_sky = make_environment_irradiance(light.map);
    const PlacedScene scene = floor_and({sphere_object({0.3, 0.2, 0}, 0.2f, Diffuse{Rgb(0.8f)})});
    const Lens lens = lens_of(40, 30, 40);
    NoisyLayers now = sample_scene(scene, light, lens, view, with_unshadowed()).layers;
    const NoisyLayers before = sample_scene(scene, light, lens, view, with_unshadowed(), 1).layers;
    const Rgb open = irradiance_on(open_sky, {0, 1, 0});
    const Layers smooth = filter_layers(now, &before, 6, {}, &open_sky);
    for (std::size_t i = 0; i < now.m.pixels.size(); ++i) {
        EXPECT_TRUE(sound(smooth.direct.e_rv_real.pixels[i]));
        EXPECT_LE(smooth.direct.e_rv_real.pixels[i].r, open.r * 1.0001);  // float rounding
    }
    now.direct.e_rv_real = now.direct.e_r;
    const Layers equal = filter_layers(now, nullptr, 6, {}, &open_sky);
    EXPECT_TRUE(same_bits(equal.direct.e_r, equal.direct.e_rv_real));
}

TEST(ShadowRatio, RefusesLayersWithoutUnshadowedLight) {
    const EnvironmentIrradiance open_sky =
        make_environment_irradiance({Image<Rgb>(2, 1, Rgb(1)), glm::dmat3(1.0)});
    EXPECT_THROW(filter_layers(noisy_plane(4, 4, 0.1, 1), nullptr, 6, {}, &open_sky), Error);
    EXPECT_THROW(make_environment_irradiance({}), Error);
}

}  // namespace
}  // namespace inlay::test
