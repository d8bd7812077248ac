// The difference form where bounds and lights are hard: finite, nothing dropped, and the same bits
// in both modes where nothing can change.
#include "recordings/base/random.h"
#include "render/filter/filter_layers.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace inlay::test {
namespace {

const Pose view = look_at({0, 1, 2}, {0, 0.2, 0});
const SamplingSettings apart{.estimator = Estimator::difference};

SceneObject real_floor() { return mesh_object(floor_mesh(3), Diffuse{Rgb(0.6f)}, true); }

SceneObject ball(const glm::dvec3& centre, float radius) {
    return sphere_object(centre, radius, Diffuse{Rgb(0.5f)});
}

/// Sampled and filtered under a light with one hot texel.
Layers sound_light(std::vector<SceneObject> objects, float radiance = 5e4f) {
    objects.push_back(real_floor());
    const PlacedScene scene(std::move(objects));
    const NoisyLayers noisy =
        sample_scene(scene, environment_of(hot_pixel_map(9, 4, radiance, 0.2f)),
                     lens_of(32, 24, 32), view, apart)
            .layers;
    expect_sound(noisy);
    EXPECT_EQ(noisy.dropped_samples, 0U);
    Layers layers = filter_layers(noisy, nullptr, 4, {});
    expect_sound(layers.direct);
    expect_sound(layers.indirect);
    return layers;
}

bool unchanged(const Layers& layers) {
    return same_bytes(layers.direct.e_r, layers.direct.e_rv_real) &&
           same_bytes(layers.indirect.e_r, layers.indirect.e_rv_real);
}

TEST(HardChange, AnObjectThatFillsTheViewAndOneOfAPixel) {
    sound_light({ball({0, 1, 1.4}, 0.55f)});
    EXPECT_FALSE(unchanged(sound_light({ball({0, 0.04, 0}, 0.03f)})));
}

TEST(HardChange, AnObjectBehindTheCameraShadesAllTheSame) {
    EXPECT_FALSE(unchanged(sound_light({ball({0, 1.5, 3.5}, 1)})));
}

TEST(HardChange, WhatLiesBelowTheSurfaceOrIsNotThereChangesNoBit) {
    EXPECT_TRUE(unchanged(sound_light({})));
    EXPECT_TRUE(unchanged(sound_light({ball({0, -1.2, 0}, 1)})));
}

TEST(HardChange, ObjectsOnTheSurfaceAndTwoHundredInOnePlace) {
    sound_light({mesh_object(floor_mesh(1), Diffuse{Rgb(0.5f)})});
    std::vector<SceneObject> crowd;
    for (std::uint32_t i = 0; i < 200; ++i) {
        const SampleKey key{1, 0, i, 0};
        crowd.push_back(
            ball({uniform(key, 0) - 0.5f, 0.1f + 0.3f * uniform(key, 1), uniform(key, 2) - 0.5f},
                 0.02f + 0.2f * uniform(key, 3)));
    }
    EXPECT_FALSE(unchanged(sound_light(crowd)));
}

/// Triangles that no ray can meet must not hide those that rays do.
TEST(HardChange, ASoupWithTrianglesThatAreNoneStillCastsItsShadow) {
    TriangleMesh soup = floor_mesh(0.5f, 0.3f);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    append(soup, quad({nan, 0, 0}, {0, 1, 0}, {1, 0, 0}));
    append(soup, quad({1e30f, 0, 0}, {0, 1e30f, 0}, {0, 0, 1e30f}));
    append(soup, quad({0, 0.4f, 0}, {0, 0, 0}, {0, 0, 0}));
    const Layers with_soup = sound_light({mesh_object(soup, Diffuse{Rgb(0.5f)})});
    const Layers clean = sound_light({mesh_object(floor_mesh(0.5f, 0.3f), Diffuse{Rgb(0.5f)})});
    EXPECT_FALSE(unchanged(with_soup));
    double soup_change = 0, clean_change = 0;
    for (std::size_t i = 0; i < clean.m.pixels.size(); ++i) {
        soup_change +=
            double(with_soup.direct.e_r.pixels[i].g - with_soup.direct.e_rv_real.pixels[i].g);
        clean_change += double(clean.direct.e_r.pixels[i].g - clean.direct.e_rv_real.pixels[i].g);
    }
    // the same shadow from other cones: 24 x 32 pixels of 16 samples stray by a few percent
    EXPECT_NEAR(soup_change / clean_change, 1, 0.15);
}

TEST(HardChange, NoLightAndLightFromOneDirectionAlone) {
    std::vector<SceneObject> objects{ball({0, 0.3, 0}, 0.3f), real_floor()};
    const PlacedScene scene(objects);
    for (const Image<Rgb>& map : {Image<Rgb>(32, 16, Rgb(0)), hot_pixel_map(9, 4, 5e4f),
                                  hot_pixel_map(3, 0, 5e4f), hot_pixel_map(9, 4, 1e-30f)}) {
        const TwoModeResult result =
            sample_scene(scene, environment_of(map), lens_of(32, 24, 32), view, apart);
        expect_sound(result.layers);
        EXPECT_EQ(result.layers.dropped_samples, 0U);
    }
}

TEST(HardChange, ExtremesOfScale) {
    for (const double scale : {1e-4, 1e4}) {
        SceneObject table = real_floor(), sphere = ball({0, 0.3, 0}, 0.3f);
        for (SceneObject* object : {&table, &sphere})
            for (int column = 0; column < 3; ++column)
                object->motion[0].world_from_object[column] *= scale;
        sphere.motion[0].world_from_object[3] = {0, 0.3 * scale, 0, 1};
        const PlacedScene scene({table, sphere});
        const NoisyLayers layers =
            sample_scene(scene, environment_of(hot_pixel_map(9, 4, 10, 0.2f)), lens_of(32, 24, 32),
                         look_at({0, scale, 2 * scale}, {0, 0.2 * scale, 0}), apart)
                .layers;
        expect_sound(layers);
        EXPECT_EQ(layers.dropped_samples, 0U);
    }
}

}  // namespace
}  // namespace inlay::test
