// The two-mode sampler against closed forms of irradiance, in both modes.
#include "render/scatter/bsdf.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace inlay::test {
namespace {

constexpr double pi = std::numbers::pi;

/// All pixels see the same point through this lens, so that they are equal but for their numbers.
const Lens point_lens = telescope(24, 24);

RunningMean red_of(const Image<Rgb>& image) {
    RunningMean m;
    for (const Rgb& c : image.pixels)
        m.add(c.r);
    return m;
}

/// A patch so small that it shades nothing: 8 mm on a side, about the origin, facing +y.
SceneObject real_patch() { return mesh_object(floor_mesh(4e-3f), Diffuse{Rgb(0.5f)}, true); }

/// From the side, towards the origin; a sphere above the origin does not get in the way.
Pose from_the_side() { return look_at({2, 0.6, 0}, {0, 0, 0}); }

TEST(TwoModes, AnOpenPlaneUnderAConstantSkyReceivesPi) {
    const PlacedScene scene({mesh_object(floor_mesh(5), Diffuse{Rgb(0.5f)}, true)});
    for (const int samples : {1, 16, 64}) {
        const NoisyLayers layers = sample_point(scene, constant_environment(1), from_the_side(),
                                                with_samples({}, samples));
        EXPECT_TRUE(has_mean(red_of(layers.direct.e_r), pi));
        EXPECT_TRUE(has_mean(red_of(layers.direct.e_rv_real), pi));
        EXPECT_TRUE(has_mean(red_of(layers.indirect.e_r), 0));
    }
}

/// The sphere covers the share (R / h)^2 of the point's cosine-weighted hemisphere. It shines with
/// its albedo, being convex in a constant environment.
TEST(TwoModes, AVirtualSphereTakesItsFormFactorAndReturnsItsAlbedo) {
    const double radius = 0.4, height = 0.8, covered = radius * radius / (height * height);
    for (const float albedo : {0.0f, 0.7f, 1.0f}) {
        const PlacedScene scene(
            {real_patch(), sphere_object({0, height, 0}, float(radius), Diffuse{Rgb(albedo)})});
        const NoisyLayers layers =
            sample_point(scene, constant_environment(1), from_the_side(), with_samples({}, 64));
        EXPECT_TRUE(has_mean(red_of(layers.direct.e_r), pi));
        EXPECT_TRUE(has_mean(red_of(layers.direct.e_rv_real), pi * (1 - covered)));
        EXPECT_TRUE(has_mean(red_of(layers.indirect.e_r), 0));
        EXPECT_TRUE(has_mean(red_of(layers.indirect.e_rv_real), pi * albedo * covered));
    }
}

TEST(TwoModes, AHalfDomeGivesPiFromAboveAndHalfOfItFromTheSide) {
    const EnvironmentSampler sky = half_environment(1, 0);
    const auto mean_under_the_sky = [&](TriangleMesh mesh, const glm::dvec3& eye) {
        const PlacedScene scene({mesh_object(std::move(mesh), Diffuse{Rgb(0.5f)}, true)});
        return red_of(sample_point(scene, sky, look_at(eye, {0, 0, 0}), {}).direct.e_r);
    };
    EXPECT_TRUE(has_mean(mean_under_the_sky(floor_mesh(1), {1, 1, 0}), pi));
    EXPECT_TRUE(
        has_mean(mean_under_the_sky(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), {1, 0.5, 1}), pi / 2));
    EXPECT_TRUE(has_mean(mean_under_the_sky(floor_mesh(1), {1, -1, 0}), 0));
}

/// Composite radiance of virtual surfaces: k_V times both irradiances, plus S_RV.
RunningMean virtual_radiance(const NoisyLayers& layers) {
    RunningMean m;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        const Rgb e = layers.direct.e_rv_virtual.pixels[i] + layers.indirect.e_rv_virtual.pixels[i];
        m.add(layers.k_v.pixels[i].r * e.r + layers.s_rv.pixels[i].r);
    }
    return m;
}

TEST(TwoModes, AVirtualSphereAloneInAFurnaceShowsItsAlbedo) {
    for (const float albedo : {0.3f, 1.0f}) {
        const PlacedScene scene({sphere_object({0, 0, 0}, 0.5f, Diffuse{Rgb(albedo)})});
        const NoisyLayers layers =
            sample_point(scene, constant_environment(1), look_at({0, 0, 3}, {0, 0.2, 0}), {});
        EXPECT_TRUE(has_mean(virtual_radiance(layers), albedo));
    }
}

/// Grazing views lose part of the lobe below the surface; such samples count as 0, in small images
/// as in large ones.
TEST(TwoModes, AGlossyPlaneInAFurnaceShowsItsDirectionalAlbedo) {
    const EnvironmentSampler furnace = constant_environment(1);
    struct GlossyCase {
        Material material;
        double theta_deg, albedo;
    };
    for (const GlossyCase& c :
         {GlossyCase{Phong{Rgb(0.3f), Rgb(0.6f), 30}, 0, 0.9},
          GlossyCase{Ggx{Rgb(1), glm::vec2(std::sqrt(0.5f)), 1, nullptr}, 60, 0.69825},
          GlossyCase{Ggx{Rgb(1), glm::vec2(1), 1, nullptr}, 80, 0.66819}}) {
        const PlacedScene scene({mesh_object(floor_mesh(10), c.material)});
        const double theta = c.theta_deg * pi / 180;
        const Pose view = look_at({0, std::cos(theta), std::sin(theta)}, {0, 0, 0}, {1, 0, 0});
        EXPECT_TRUE(has_mean(virtual_radiance(sample_point(scene, furnace, view, {})), c.albedo));

        RunningMean one_pixel;
        for (std::uint32_t frame = 0; frame < 500; ++frame)
            one_pixel.add(virtual_radiance(sample_scene(scene, furnace, telescope(1, 1), view,
                                                        with_samples({}, 16), frame)
                                               .layers)
                              .mean);
        EXPECT_TRUE(has_mean(one_pixel, c.albedo)) << "one pixel";
    }
}

/// S_RV is a mean over all samples on virtual surfaces, glossy or not: half of the pixels' area is
/// a plate that reflects 0.8 along its normal, the other half is diffuse.
TEST(TwoModes, GlossyRadianceIsAMeanOverAllVirtualSamples) {
    const PlacedScene scene(
        {mesh_object(quad({-1, -1, 0}, {1, 0, 0}, {0, 2, 0}), Phong{Rgb(0), Rgb(0.8f), 1000}),
         mesh_object(quad({0, -1, 0}, {1, 0, 0}, {0, 2, 0}), Diffuse{Rgb(0)})});
    RunningMean m;
    for (std::uint32_t frame = 0; frame < 300; ++frame)
        m.add(sample_scene(scene, constant_environment(1), telescope(1, 1),
                           look_at({0, 0, 3}, {0, 0, 0}), with_samples({}, 16), frame)
                  .layers.s_rv(0, 0)
                  .r);
    EXPECT_TRUE(has_mean(m, 0.4));
}

/// Real surfaces all around, at random distances, that shine with radiance 1 over a share of the
/// hemisphere: E_ind = pi times the share. Without the factor pi it would be the share alone.
TEST(TwoModes, IndirectLightCarriesTheFactorPi) {
    for (const double share : {1.0, 0.5}) {
        RealGeometry real = no_real_geometry();
        real.primary = [](const RayPacket& rays, const auto&) {
            RealPrimaryHits hits;
            for (std::size_t i = 0; i < packet_width; ++i)
                hits.pixel[i] = {1, rays.origin[i] + rays.direction[i], {0, 1, 0}};
            return hits;
        };
        real.radiances = [share](const RayPacket& rays, const SampleKeys&) {
            RealHits hits;
            for (std::size_t i = 0; i < packet_width; ++i) {
                const bool covered = share == 1 || rays.direction[i].x > 0;
                hits.distance[i] = covered ? 1 : no_hit;
                hits.radiance[i] = Rgb(covered ? 1 : 0);
            }
            return hits;
        };
        const EmbreeScene no_objects;
        const EnvironmentSampler sky = constant_environment(1);
        const TwoModeScene scene{point_lens, from_the_side(), real, no_objects, sky};
        const NoisyLayers layers = sample_two_modes(scene, {}, 0).layers;
        EXPECT_TRUE(has_mean(red_of(layers.indirect.e_r), pi * share));
        EXPECT_TRUE(has_mean(red_of(layers.indirect.e_rv_real), pi * share));
    }
}

/// Half of the pixel is a real floor, half a virtual wall in front of it. Each kind of surface has
/// its own mean: pi and pi / 2 under the half-dome, whatever share of the pixel it covers.
TEST(TwoModes, SilhouettesKeepRealAndVirtualLightApart) {
    const PlacedScene scene(
        {real_patch(), mesh_object(quad({0, -1, 0.5f}, {1, 0, 0}, {0, 2, 0}), Diffuse{Rgb(0)})});
    // The wall's edge passes in front of the origin.
    const Pose view = look_at({0, 2, 2}, {0, 0, 0});
    RunningMean coverage, real_only, on_virtual;
    for (std::uint32_t frame = 0; frame < 60; ++frame) {
        const NoisyLayers layers =
            sample_scene(scene, half_environment(1, 0), lens_of(1, 1, 1e3), view,
                         {.primary = 64, .secondary = 1, .seed = frame + 1})
                .layers;
        coverage.add(layers.m(0, 0));
        real_only.add(layers.direct.e_r(0, 0).r);
        on_virtual.add(layers.direct.e_rv_virtual(0, 0).r);
    }
    EXPECT_TRUE(has_mean(coverage, 0.5));
    EXPECT_TRUE(has_mean(real_only, pi));
    EXPECT_TRUE(has_mean(on_virtual, pi / 2));
}

}  // namespace
}  // namespace inlay::test
