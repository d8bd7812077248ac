// What a plan leaves out is not done.
#include "composite/session/obey_plan.h"

#include "composite/session/render_view.h"
#include "recordings/base/check.h"
#include "tests/support/tabletop.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

const Lens lens{48, 36, 45, 45, 23.5, 17.5};

EnvironmentMap black() { return {Image<Rgb>(16, 8, Rgb(0))}; }

VirtualScene table_with(const VirtualScene& objects) {
    VirtualScene scene = test::tabletop();
    for (const SceneObject& object : objects.objects)
        scene.objects.push_back(object);
    return scene;
}

OutputFrame render(const VirtualScene& scene, const EnvironmentMap& light, bool filter = true) {
    const EnvironmentSampler environment = make_environment_sampler(light);
    Settings settings;
    settings.filter.enabled = filter;
    settings.trace = with_samples(settings.trace, 4);
    return render_view({scene, environment, lens, test::camera_around(0)}, settings, 4);
}

TEST(Plan, NoLightIsBlackAndDrawsNothing) {
    const EnvironmentSampler dark = no_light();
    EXPECT_EQ(dark.mean_luminance, 0);
    for (const float u : {0.0f, 0.3f, 0.999f})
        EXPECT_EQ(sample_environment(dark, {u, 1 - u}).pdf, 0);
}

TEST(Plan, WithoutLightNoShadowRayIsTraced) {
    const OutputFrame dark = render(table_with(test::two_virtual_balls()), black());
    EXPECT_FALSE(dark.plan.has("environment_direct"));
    EXPECT_GT(dark.rays.primary, 0u);
    EXPECT_EQ(dark.rays.virtual_shadow, 0u);
    EXPECT_EQ(dark.rays.real_shadow, 0u);
    for (const Rgb& c : dark.composite.linear.pixels)
        ASSERT_EQ(c, Rgb(0));
    EXPECT_GT(render(table_with(test::two_virtual_balls()), test::soft_light()).rays.real_shadow,
              0u);  // or the zeros above would say nothing
}

TEST(Plan, WithoutVirtualObjectsAViewIsThePhotographAlone) {
    const OutputFrame empty = render(test::tabletop(), test::soft_light());
    EXPECT_TRUE(empty.plan.names().empty());
    EXPECT_EQ(empty.rays.primary, 0u);
    EXPECT_EQ(empty.noisy, nullptr);
    EXPECT_EQ(empty.composite.linear.pixels, empty.camera.pixels);
}

TEST(Plan, WithoutTheFilterTheMeansPassAndNothingIsAllocated) {
    const OutputFrame out =
        render(table_with(test::two_virtual_balls()), test::soft_light(), /*filter=*/false);
    EXPECT_FALSE(out.plan.has("axis_aligned_filter"));
    EXPECT_EQ(out.layers.direct.e_rv_real.pixels, out.noisy->direct.e_rv_real.pixels);
    EXPECT_EQ(out.layers.s_rv.pixels, out.noisy->s_rv.pixels);
    EXPECT_TRUE(out.layers.bandwidth_direct.empty());
    EXPECT_TRUE(out.layers.bandwidth_indirect.empty());
}

TEST(RenderView, StopsBetweenPasses) {
    const VirtualScene scene = table_with(test::two_virtual_balls());
    const EnvironmentSampler environment = make_environment_sampler(test::soft_light());
    Settings settings;
    settings.trace = with_samples(settings.trace, 4);
    for (int passes = 1; passes <= 3; ++passes) {
        int asked = 0;
        try {
            render_view({scene, environment, lens, test::camera_around(0)}, settings, 4,
                        [&] { return ++asked == passes; });
            FAIL() << "went on after pass " << passes;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ExitCode::interrupted);
            EXPECT_EQ(asked, passes);
        }
    }
}

}  // namespace
}  // namespace inlay
