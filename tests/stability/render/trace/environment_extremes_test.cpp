// Extreme light: the tracers stay finite, and what cannot be light is refused.
#include "recordings/base/check.h"
#include "render/trace/picture.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

namespace inlay::test {
namespace {

std::vector<SceneObject> still_life() {
    return {mesh_object(floor_mesh(3), Diffuse{Rgb(0.6f)}, true),
            sphere_object({-0.5, 0.3, 0}, 0.3f, Diffuse{Rgb(1)}),
            sphere_object({0.3, 0.3, 0.2}, 0.3f, Phong{Rgb(0.2f), Rgb(0.8f), 1e4f}),
            sphere_object({0.9, 0.3, -0.3}, 0.3f, Ggx{Rgb(1), {0.0f, 1.0f}, 1, nullptr})};
}

struct Light {
    std::string name;
    Image<Rgb> map;
};

std::vector<Light> extreme_lights() {
    return {{"constant", Image<Rgb>(16, 8, Rgb(1))},
            {"black", Image<Rgb>(16, 8, Rgb(0))},
            {"hot pixel", hot_pixel_map(9, 4, 5e4f)},
            {"hot pixel at the pole", hot_pixel_map(3, 0, 5e4f)},
            {"hot pixel at the lower pole", hot_pixel_map(31, 15, 5e4f)},
            {"hotter than half floats", hot_pixel_map(9, 4, 1e20f)},
            {"denormal", Image<Rgb>(4, 2, Rgb(1e-42f))},
            {"one texel", Image<Rgb>(1, 1, Rgb(2))},
            {"one color", Image<Rgb>(8, 4, Rgb(0, 0, 3))}};
}

class ExtremeLight : public ::testing::TestWithParam<int> {};

TEST_P(ExtremeLight, LayersStayFinite) {
    const Light light = extreme_lights()[std::size_t(GetParam())];
    SCOPED_TRACE(light.name);
    const PlacedScene scene(still_life());
    const Pose view = look_at({0, 1, 2}, {0.2, 0.2, 0});
    const NoisyLayers layers =
        sample_scene(scene, environment_of(light.map), lens_of(40, 30, 40), view, {}).layers;
    expect_sound(layers);
    EXPECT_EQ(layers.dropped_samples, 0U);
}

TEST_P(ExtremeLight, PathsStayFinite) {
    const Light light = extreme_lights()[std::size_t(GetParam())];
    SCOPED_TRACE(light.name);
    const PlacedScene scene(still_life());
    const PictureView view{lens_of(40, 30, 40), look_at({0, 1, 2}, {0.2, 0.2, 0})};
    const Picture picture = trace_picture(scene.all, environment_of(light.map), view, 8);
    EXPECT_TRUE(sound(picture.radiance, "radiance"));
    EXPECT_EQ(picture.dropped_samples, 0U);
}

INSTANTIATE_TEST_SUITE_P(Lights, ExtremeLight, ::testing::Range(0, int(extreme_lights().size())));

TEST(ExtremeLight, BlackLightLeavesExactlyNothing) {
    const PlacedScene scene(still_life());
    const NoisyLayers layers = sample_scene(scene, constant_environment(0), lens_of(12, 9, 10),
                                            look_at({0, 1, 2}, {0, 0, 0}), {})
                                   .layers;
    const Image<Rgb> nothing(12, 9, Rgb(0));
    for (const Irradiance& e : {layers.direct, layers.indirect}) {
        EXPECT_TRUE(same_bytes(e.e_r, nothing));
        EXPECT_TRUE(same_bytes(e.e_rv_real, nothing));
        EXPECT_TRUE(same_bytes(e.e_rv_virtual, nothing));
    }
    EXPECT_TRUE(same_bytes(layers.s_rv, nothing));
}

TEST(ExtremeLight, ATexelThatIsNotANumberIsRefusedWithItsPlace) {
    Image<Rgb> map(16, 8, Rgb(1));
    map(13, 6).b = NAN;
    try {
        environment_of(std::move(map));
        FAIL() << "accepted";
    } catch (const Error& e) {
        EXPECT_EQ(e.code(), ExitCode::bad_data);
        EXPECT_THAT(e.what(), ::testing::HasSubstr("(13, 6)"));
    }
}

}  // namespace
}  // namespace inlay::test
