// What a plan leaves out is not done.
#include "composite/session/obey_plan.h"

#include "composite/session/render_view.h"
#include "recordings/base/check.h"
#include "render/filter/filter_layers.h"
#include "render/trace/real_geometry.h"
#include "render/trace/sample_pass.h"
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

TEST(Plan, AFarObjectOutOfViewLeavesThePhotographAloneAndANearOneDoesNot) {
    const auto behind_the_camera = [](double z) {
        return render(
            table_with({{test::ball("ball", {0, 0.6, z}, 0.15f, Diffuse{Rgb(0.9f)}, false)}}),
            test::soft_light());
    };
    const OutputFrame far = behind_the_camera(87);
    EXPECT_TRUE(far.plan.names().empty());
    EXPECT_EQ(far.rays.primary + far.rays.virtual_shadow + far.rays.virtual_indirect +
                  far.rays.real_shadow + far.rays.real_indirect,
              0u);
    EXPECT_EQ(far.noisy, nullptr);
    EXPECT_EQ(far.composite.linear.pixels, far.camera.pixels);
    EXPECT_EQ(far.composite.display.pixels, encode(far.camera).pixels);

    const OutputFrame near = behind_the_camera(1.3);
    EXPECT_FALSE(near.plan.has("virtual_surfaces"));
    EXPECT_GT(near.rays.primary, 0u);
    EXPECT_GT(near.rays.virtual_shadow, 0u);
    EXPECT_GT(near.composite.influenced_pixels, 0u);
}

TEST(Plan, ObjectsBringEveryClassOfRays) {
    const OutputFrame out = render(table_with(test::two_virtual_balls()), test::soft_light());
    for (const std::uint64_t count :
         {out.rays.primary, out.rays.virtual_shadow, out.rays.virtual_indirect,
          out.rays.real_shadow, out.rays.real_indirect})
        EXPECT_GT(count, 0u);
}

/// The sampler's result for a scene, with what the plan leaves out or with everything.
TwoModeResult sample(const VirtualScene& objects, bool as_planned) {
    const VirtualScene scene = table_with(objects);
    const EnvironmentSampler environment = make_environment_sampler(test::soft_light());
    EmbreeSceneCache cache;
    const EmbreeScene real = cache.place(scene, 0, true), on_top = cache.place(scene, 0, false);
    const SceneView view{scene, environment, lens, test::camera_around(0)};
    SamplingSettings settings = with_samples({.estimator = Estimator::difference}, 4);
    if (as_planned)
        settings = planned_sampling(plan_effects(facts_of_view(view), settings, {}), settings);
    return sample_two_modes(
        {lens, view.world_from_camera, exact_real_geometry(real, environment, first_path_dimension),
         on_top, environment},
        settings, 0);
}

bool same(const RayCounts& a, const RayCounts& b) {
    return a.primary == b.primary && a.virtual_shadow == b.virtual_shadow &&
           a.virtual_indirect == b.virtual_indirect && a.real_shadow == b.real_shadow &&
           a.real_indirect == b.real_indirect;
}

/// What light does on real surfaces, to the bit.
bool same_on_real(const NoisyLayers& a, const NoisyLayers& b) {
    return a.m.pixels == b.m.pixels && a.direct.e_r.pixels == b.direct.e_r.pixels &&
           a.direct.e_rv_real.pixels == b.direct.e_rv_real.pixels &&
           a.indirect.e_r.pixels == b.indirect.e_r.pixels &&
           a.indirect.e_rv_real.pixels == b.indirect.e_rv_real.pixels &&
           a.real.object.pixels == b.real.object.pixels;
}

/// A ball that the camera does not see and that shadows the table.
VirtualScene ball_above_the_view(const Material& material) {
    return {{test::ball("lamp", {0.1, 0.75, 0.1}, 0.15f, material, false)}};
}

TEST(Plan, ObjectsOutOfViewHaveNoBufferAndTheSameShadow) {
    const TwoModeResult planned = sample(ball_above_the_view(Diffuse{}), true);
    const TwoModeResult all = sample(ball_above_the_view(Diffuse{}), false);
    EXPECT_TRUE(planned.layers.k_v.empty());
    EXPECT_TRUE(planned.layers.s_rv.empty());
    EXPECT_TRUE(planned.layers.direct.e_rv_virtual.empty());
    EXPECT_TRUE(planned.layers.indirect.e_rv_virtual.empty());
    EXPECT_TRUE(planned.layers.virtual_.object.empty());
    EXPECT_TRUE(planned.layers.virtual_.position.empty());
    // Each of the 4 camera rays of a pixel once for what it sees, and once more, at most, for E_R.
    EXPECT_GE(planned.rays.primary, std::uint64_t(lens.width * lens.height * 4));
    EXPECT_LE(planned.rays.primary, std::uint64_t(lens.width * lens.height * 4 * 2));
    EXPECT_TRUE(same(planned.rays, all.rays));  // what is left out brought nothing
    EXPECT_TRUE(same_on_real(planned.layers, all.layers));
    EXPECT_NE(planned.layers.direct.e_rv_real.pixels, planned.layers.direct.e_r.pixels);

    const TwoModeResult seen = sample(test::two_virtual_balls(), true);
    EXPECT_FALSE(seen.layers.k_v.empty());
    EXPECT_FALSE(seen.layers.virtual_.object.empty());
    EXPECT_GT(seen.rays.primary, planned.rays.primary);  // coverage rays
}

TEST(Plan, AFrameWithObjectsOutOfViewIsTheSameWithTheFilter) {
    const OutputFrame out = render(table_with(ball_above_the_view(Diffuse{})), test::soft_light());
    EXPECT_FALSE(out.plan.has("virtual_surfaces"));
    EXPECT_EQ(out.composite.virtual_pixels, 0u);
    EXPECT_GT(out.composite.influenced_pixels, 0u);
    EXPECT_TRUE(out.layers.direct.e_rv_virtual.empty());
    EXPECT_TRUE(out.layers.s_rv.empty());
    const NoisyLayers all = sample(ball_above_the_view(Diffuse{}), false).layers;
    EXPECT_TRUE(same_on_real(*out.noisy, all));
}

bool same(const Layers& a, const Layers& b) {
    return a.m.pixels == b.m.pixels && a.direct.e_r.pixels == b.direct.e_r.pixels &&
           a.direct.e_rv_real.pixels == b.direct.e_rv_real.pixels &&
           a.indirect.e_rv_real.pixels == b.indirect.e_rv_real.pixels &&
           a.bandwidth_direct.pixels == b.bandwidth_direct.pixels &&
           a.bandwidth_indirect.pixels == b.bandwidth_indirect.pixels;
}

TEST(Plan, TheFilterTakesFramesBetweenWhichAnObjectCameOrWent) {
    const NoisyLayers seen = sample(test::two_virtual_balls(), true).layers;
    const NoisyLayers unseen = sample(ball_above_the_view(Diffuse{}), true).layers;
    const NoisyLayers unseen_all = sample(ball_above_the_view(Diffuse{}), false).layers;
    constexpr double bandwidth = 5;  // 1/rad
    const Layers came = filter_layers(seen, &unseen, bandwidth, {});
    const Layers came_all = filter_layers(seen, &unseen_all, bandwidth, {});
    EXPECT_TRUE(same(came, came_all));
    EXPECT_EQ(came.s_rv.pixels, came_all.s_rv.pixels);
    EXPECT_EQ(came.direct.e_rv_virtual.pixels, came_all.direct.e_rv_virtual.pixels);
    const Layers went = filter_layers(unseen, &seen, bandwidth, {});
    EXPECT_TRUE(same(went, filter_layers(unseen_all, &seen, bandwidth, {})));
    EXPECT_TRUE(went.k_v.empty());
    EXPECT_TRUE(went.direct.e_rv_virtual.empty());
}

VirtualScene red_ball(const Material& material) {
    return {{test::ball("red", {0.05, 0.08, 0.05}, 0.08f, material, false)}};
}

const Rgb red{0.5f, 0.1f, 0.05f};
const Material shiny_red = Phong{red, Rgb(0.4f), 64};

TEST(Plan, WithoutAGlossySurfaceInViewNoLobeIsFollowed) {
    const TwoModeResult planned = sample(red_ball(Diffuse{red}), true);
    const TwoModeResult all = sample(red_ball(Diffuse{red}), false);
    EXPECT_TRUE(planned.layers.s_rv.empty());
    EXPECT_TRUE(planned.layers.glossy_bandwidth.empty());
    EXPECT_FALSE(planned.layers.k_v.empty());
    EXPECT_TRUE(same(planned.rays, all.rays));
    EXPECT_TRUE(same_on_real(planned.layers, all.layers));
    EXPECT_EQ(planned.layers.direct.e_rv_virtual.pixels, all.layers.direct.e_rv_virtual.pixels);
    EXPECT_EQ(planned.layers.indirect.e_rv_virtual.pixels, all.layers.indirect.e_rv_virtual.pixels);

    const TwoModeResult shiny = sample(red_ball(shiny_red), true);
    EXPECT_FALSE(shiny.layers.s_rv.empty());
    EXPECT_FALSE(shiny.layers.glossy_bandwidth.empty());
    EXPECT_GT(shiny.rays.virtual_indirect, planned.rays.virtual_indirect);
    EXPECT_GT(shiny.rays.real_indirect, planned.rays.real_indirect);
}

TEST(Plan, AGlossyLobeChangesWhatItIsSeenInAndLightThatItSendsAndNothingElse) {
    const NoisyLayers plain = sample(red_ball(Diffuse{red}), true).layers;
    const NoisyLayers shiny = sample(red_ball(shiny_red), true).layers;
    EXPECT_EQ(plain.m.pixels, shiny.m.pixels);
    EXPECT_EQ(plain.k_v.pixels, shiny.k_v.pixels);
    EXPECT_EQ(plain.direct.e_r.pixels, shiny.direct.e_r.pixels);
    EXPECT_EQ(plain.direct.e_rv_real.pixels, shiny.direct.e_rv_real.pixels);
    EXPECT_EQ(plain.direct.e_rv_virtual.pixels, shiny.direct.e_rv_virtual.pixels);
    EXPECT_EQ(plain.indirect.e_r.pixels, shiny.indirect.e_r.pixels);
    EXPECT_NE(plain.indirect.e_rv_real.pixels, shiny.indirect.e_rv_real.pixels);
    double seen = 0;
    for (std::size_t i = 0; i < shiny.m.pixels.size(); ++i) {
        if (shiny.m.pixels[i] == 1) {
            EXPECT_EQ(shiny.s_rv.pixels[i], Rgb(0));
        }
        seen += double(shiny.s_rv.pixels[i].r);
    }
    EXPECT_GT(seen, 0);
}

TEST(Plan, AGlossyObjectOutOfViewIsOnlyMetByIndirectRays) {
    const TwoModeResult plain = sample(ball_above_the_view(Diffuse{red}), true);
    const TwoModeResult shiny = sample(ball_above_the_view(shiny_red), true);
    EXPECT_TRUE(shiny.layers.s_rv.empty());
    EXPECT_EQ(plain.rays.virtual_indirect, shiny.rays.virtual_indirect);
    EXPECT_EQ(plain.layers.direct.e_rv_real.pixels, shiny.layers.direct.e_rv_real.pixels);
    EXPECT_NE(plain.layers.indirect.e_rv_real.pixels, shiny.layers.indirect.e_rv_real.pixels);
    EXPECT_TRUE(same_on_real(shiny.layers, sample(ball_above_the_view(shiny_red), false).layers));
}

TEST(Plan, TheStatedCostIsAnUpperBoundOfTheRays) {
    const double pixels = lens.width * lens.height;
    for (const VirtualScene& objects :
         {red_ball(Diffuse{}), red_ball(shiny_red), test::two_virtual_balls(),
          ball_above_the_view(shiny_red),
          VirtualScene{{test::ball("about the camera", {0, 0.6, 0.9}, 0.5f, shiny_red, false)}}}) {
        const OutputFrame out = render(table_with(objects), test::soft_light());
        const RaysPerPixel bound = out.plan.rays();
        EXPECT_LE(double(out.rays.primary), pixels * bound.primary);
        EXPECT_LE(double(out.rays.virtual_shadow), pixels * bound.virtual_shadow);
        EXPECT_LE(double(out.rays.virtual_indirect), pixels * bound.virtual_indirect);
        EXPECT_LE(double(out.rays.real_shadow), pixels * bound.real_shadow);
        EXPECT_LE(double(out.rays.real_indirect), pixels * bound.real_indirect);
    }
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
