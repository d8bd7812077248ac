// The same bytes for any number of threads, structures built anew each time.
#include "recordings/base/parallel.h"
#include "render/trace/picture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

namespace inlay::test {
namespace {

/// Enough triangles that building their structure is worth several threads.
std::vector<SceneObject> busy_scene() {
    SceneObject bowl = mesh_object(bowl_mesh(0.5, 96), Diffuse{Rgb(0.7f)});
    bowl.motion[0].world_from_object[3] = {0.4, 1, -0.5, 1};
    return {mesh_object(floor_mesh(3), Diffuse{Rgb(0.6f)}, true), bowl,
            sphere_object({-0.6, 0.3, 0}, 0.3f, Phong{Rgb(0.2f), Rgb(0.7f), 60}),
            sphere_object({0, 0.2, 0.6}, 0.2f, Ggx{Rgb(0.9f), glm::vec2(0.4f), 0, nullptr})};
}

TwoModeResult layers_with(int threads, Estimator estimator) {
    set_thread_count(threads);
    TwoModeResult result = sample_scene(
        PlacedScene(busy_scene()), environment_of(hot_pixel_map(9, 4, 300, 0.5f)),
        lens_of(50, 37, 50), look_at({0, 1, 2.5}, {0, 0.3, 0}), {.estimator = estimator});
    set_thread_count(0);
    return result;
}

TEST(Threads, TheSamplersBytesDoNotDependOnTheirNumber) {
    for (const Estimator estimator : {Estimator::two_mode, Estimator::difference}) {
        const TwoModeResult one = layers_with(1, estimator);
        for (const int threads : {2, 3, 7}) {
            const TwoModeResult many = layers_with(threads, estimator);
            EXPECT_TRUE(same_bytes(one.layers, many.layers)) << threads;
            EXPECT_EQ(one.layers.dropped_samples, many.layers.dropped_samples);
            EXPECT_EQ(one.rays.real_shadow, many.rays.real_shadow);
            EXPECT_EQ(one.rays.virtual_indirect, many.rays.virtual_indirect);
        }
    }
}

Picture picture_with(int threads) {
    set_thread_count(threads);
    const PlacedScene scene(busy_scene());
    Picture picture = trace_picture(scene.all, environment_of(hot_pixel_map(9, 4, 300, 0.5f)),
                                    {lens_of(50, 37, 50), look_at({0, 1, 2.5}, {0, 0.3, 0})}, 4);
    set_thread_count(0);
    return picture;
}

TEST(Threads, ThePathTracersBytesDoNotDependOnTheirNumber) {
    const Picture one = picture_with(1);
    for (const int threads : {2, 5}) {
        const Picture many = picture_with(threads);
        EXPECT_TRUE(same_bytes(one.radiance, many.radiance)) << threads;
        EXPECT_TRUE(same_bytes(one.standard_error, many.standard_error)) << threads;
    }
}

/// A pixel's numbers are its own: a larger image does not change the pixels of its rows above.
TEST(Threads, PixelsKnowNothingOfTheirNeighbours) {
    const PlacedScene scene(busy_scene());
    const EnvironmentSampler light = environment_of(hot_pixel_map(9, 4, 300, 0.5f));
    Lens lens = lens_of(21, 13, 20);
    const Pose view = look_at({0, 1, 2.5}, {0, 0.3, 0});
    const NoisyLayers low = sample_scene(scene, light, lens, view, {}).layers;
    lens.height = 15;  // the last tile row now holds more lanes
    const NoisyLayers high = sample_scene(scene, light, lens, view, {}).layers;
    for (std::size_t i = 0; i < low.m.pixels.size(); ++i) {
        EXPECT_EQ(low.direct.e_rv_real.pixels[i], high.direct.e_rv_real.pixels[i]);
        EXPECT_EQ(low.indirect.e_rv_virtual.pixels[i], high.indirect.e_rv_virtual.pixels[i]);
        EXPECT_EQ(low.s_rv.pixels[i], high.s_rv.pixels[i]);
    }
}

}  // namespace
}  // namespace inlay::test
