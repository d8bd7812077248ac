// The two-mode sampler: shared random numbers, sample counts, occluder rates, who hides whom.
#include "render/trace/two_mode_sampler.h"

#include "recordings/base/check.h"
#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace inlay::test {
namespace {

const Pose view = look_at({0, 1.5, 2}, {0, 0, 0});

EnvironmentSampler lobe_environment() {
    return environment_of(lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2)));
}

SceneObject real_floor() { return mesh_object(floor_mesh(3), Diffuse{Rgb(0.6f)}, true); }

SceneObject real_box() {
    SceneObject box = mesh_object(cube_mesh(0.2f), Diffuse{Rgb(0.6f, 0.3f, 0.2f)}, true);
    box.motion[0].world_from_object[3] = {-0.5, 0.2, 0, 1};
    return box;
}

bool same(const Image<Rgb>& a, const Image<Rgb>& b, std::size_t i) {
    return std::memcmp(&a.pixels[i], &b.pixels[i], sizeof(Rgb)) == 0;
}

TEST(TwoModeSampler, WithoutVirtualGeometryInReachBothModesAreTheSameBits) {
    const std::vector<SceneObject> nothing,
        behind_the_floor{sphere_object({0, -2, 0}, 1, Phong{Rgb(0.5f), Rgb(0.5f), 10})};
    for (const auto& objects : {nothing, behind_the_floor}) {
        std::vector<SceneObject> all = objects;
        all.push_back(real_floor());
        all.push_back(real_box());
        const PlacedScene scene(all);
        for (const int samples : {1, 2, 3, 4, 16, 64}) {
            const NoisyLayers layers = sample_scene(scene, lobe_environment(), lens_of(13, 10, 12),
                                                    view, with_samples({}, samples))
                                           .layers;
            EXPECT_TRUE(same_bytes(layers.direct.e_r, layers.direct.e_rv_real)) << samples;
            EXPECT_TRUE(same_bytes(layers.indirect.e_r, layers.indirect.e_rv_real)) << samples;
            for (const float m : layers.m.pixels)
                EXPECT_EQ(m, 1);
        }
    }
}

/// The same scene without its virtual objects says which pixels they changed: E_R is the same bits
/// everywhere the camera sees no virtual surface, and E_RV differs near the object, not elsewhere.
TEST(TwoModeSampler, AVirtualObjectChangesOnlyThePixelsWhoseSamplesMeetIt) {
    const auto sphere = sphere_object({0.3, 0.2, 0}, 0.2f, Diffuse{Rgb(0.8f)});
    const PlacedScene with({real_floor(), real_box(), sphere}), without({real_floor(), real_box()});
    const Lens lens = lens_of(40, 30, 40);
    const NoisyLayers a = sample_scene(with, lobe_environment(), lens, view, {}).layers;
    const NoisyLayers b = sample_scene(without, lobe_environment(), lens, view, {}).layers;
    int unchanged = 0, changed = 0;
    for (std::size_t i = 0; i < a.m.pixels.size(); ++i) {
        if (a.m.pixels[i] != 1) continue;
        EXPECT_TRUE(same(a.direct.e_r, b.direct.e_r, i));
        EXPECT_TRUE(same(a.indirect.e_r, b.indirect.e_r, i));
        const bool equal = same(a.direct.e_r, a.direct.e_rv_real, i) &&
                           same(a.indirect.e_r, a.indirect.e_rv_real, i);
        (equal ? unchanged : changed) += 1;
    }
    EXPECT_GT(unchanged, 50);
    EXPECT_GT(changed, 50);
}

TEST(TwoModeSampler, TheKeyAloneDecidesTheBytes) {
    const PlacedScene scene({real_floor(), sphere_object({0, 0.3, 0}, 0.3f, Diffuse{})});
    const Lens lens = lens_of(16, 12, 16);
    const EnvironmentSampler light = lobe_environment();
    const NoisyLayers a = sample_scene(scene, light, lens, view, {}, 5).layers;
    EXPECT_TRUE(same_bytes(a, sample_scene(scene, light, lens, view, {}, 5).layers));
    EXPECT_FALSE(same_bytes(a, sample_scene(scene, light, lens, view, {}, 6).layers));
    SamplingSettings other_seed;
    other_seed.seed = 2;
    EXPECT_FALSE(same_bytes(a, sample_scene(scene, light, lens, view, other_seed, 5).layers));
}

TEST(TwoModeSampler, SplitsSamplesAsPromised) {
    for (const int samples : {1, 2, 3, 4, 16, 64}) {
        const SamplingSettings s = with_samples({}, samples);
        EXPECT_EQ(s.primary, std::min(samples, 4));
        EXPECT_EQ(s.primary * s.secondary, samples);
    }
    for (const int samples : {0, -4, 5, 6, 18})
        EXPECT_THROW(with_samples({}, samples), Error) << samples;
}

/// Mean square of the coverage's error over the pixels that some reference ray sees an edge in.
double coverage_error(const NoisyLayers& layers, const NoisyLayers& reference) {
    double sum = 0;
    int edges = 0;
    for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
        if (reference.m.pixels[i] == 0 || reference.m.pixels[i] == 1) continue;
        sum += std::pow(double(layers.m.pixels[i] - reference.m.pixels[i]), 2);
        ++edges;
    }
    EXPECT_GT(edges, 30);
    return sum / edges;
}

TEST(TwoModeSampler, CoverageRaysSharpenEdgesAndLeaveTheRestAlone) {
    const PlacedScene scene({real_floor(), sphere_object({0.3, 0.4, 0}, 0.3f, Diffuse{})});
    const Lens lens = lens_of(40, 30, 40);
    SamplingSettings plain;
    plain.coverage = 0;
    SamplingSettings many = plain;
    many.primary = 256;
    many.secondary = 1;
    const auto layers_of = [&](const SamplingSettings& settings) {
        return sample_scene(scene, lobe_environment(), lens, view, settings).layers;
    };
    const NoisyLayers four = layers_of(plain), refined = layers_of({}), reference = layers_of(many);
    // Stratified in two dimensions, an edge's error falls faster than by 1 / sqrt(32 / 4).
    EXPECT_LT(coverage_error(refined, reference), coverage_error(four, reference) / 8);
    int only_glimpsed = 0;
    for (std::size_t i = 0; i < refined.m.pixels.size(); ++i) {
        EXPECT_TRUE(same(refined.direct.e_r, four.direct.e_r, i) || four.m.pixels[i] == 0);
        if (refined.m.pixels[i] == 1) continue;
        EXPECT_NE(refined.virtual_.object.pixels[i], 0U);  // what is shown has received light
        if (four.m.pixels[i] < 1) continue;
        ++only_glimpsed;
        EXPECT_GT(luminance(refined.direct.e_rv_virtual.pixels[i]) +
                      luminance(refined.indirect.e_rv_virtual.pixels[i]),
                  0);
    }
    EXPECT_GT(only_glimpsed, 3);
}

TEST(TwoModeSampler, RefusesSettingsOutOfRange) {
    EXPECT_NO_THROW(validate(SamplingSettings{}));
    for (const SamplingSettings& bad :
         {SamplingSettings{.primary = 0}, SamplingSettings{.secondary = 0},
          SamplingSettings{.coverage = -1}, SamplingSettings{.virtual_repeats = 0},
          SamplingSettings{.light_tries = 0}, SamplingSettings{.depth_tolerance = -0.1f},
          SamplingSettings{.occluder_floor = 2}, SamplingSettings{.ignored_luminance = NAN}}) {
        try {
            validate(bad);
            FAIL();
        } catch (const Error& e) {
            EXPECT_EQ(e.code(), ExitCode::usage);
        }
    }
}

TEST(TwoModeSampler, CountsItsRays) {
    const PlacedScene scene({real_floor()});
    const RayCounts rays =
        sample_scene(scene, lobe_environment(), lens_of(7, 5, 100), view, {}).rays;
    EXPECT_EQ(rays.primary, 7U * 5 * 4);
    EXPECT_EQ(rays.virtual_indirect, 7U * 5 * 16);
    EXPECT_EQ(rays.real_indirect, 7U * 5 * 16);
    EXPECT_LE(rays.real_shadow, 7U * 5 * 16);  // lights below the floor are not asked for
    EXPECT_GT(rays.real_shadow, 0U);
}

/// Occluders at distances of the direction's own: the rate is the largest cos / r among them, not
/// cos^2 / r, and not the nearest occluder's.
TEST(TwoModeSampler, OccluderRatesAreTheLargestCosineOverDistance) {
    const auto distance = [](const glm::vec3& d) { return 0.5f + d.x * d.x; };
    float shadow_rate = 0, indirect_rate = 0;
    const auto widen = [&](float& rate, const RayPacket& rays) {
        DistancePacket distances;
        distances.fill(no_hit);
        for (int lane = 0; lane < packet_width; ++lane) {
            if (!rays.has(lane)) continue;
            const glm::vec3 d = rays.direction[std::size_t(lane)];
            distances[std::size_t(lane)] = distance(d);
            rate = std::max(rate, d.y / distance(d));
        }
        return distances;
    };
    RealGeometry real = no_real_geometry();
    real.primary = [](const RayPacket&, const auto&) {
        RealPrimaryHits hits;
        hits.pixel.fill({1, glm::vec3(0), glm::vec3(0, 1, 0)});
        return hits;
    };
    real.distances = [&](const RayPacket& rays) { return widen(shadow_rate, rays); };
    real.radiances = [&](const RayPacket& rays, const SampleKeys&) {
        return RealHits{widen(indirect_rate, rays), {}};
    };
    const EmbreeScene no_objects;
    const EnvironmentSampler sky = constant_environment(1);
    const NoisyLayers layers =
        sample_two_modes({lens_of(1, 1, 1), view, real, no_objects, sky}, with_samples({}, 64), 0)
            .layers;
    EXPECT_NEAR(layers.real.occluder_direct(0, 0), shadow_rate, 1e-6);
    EXPECT_NEAR(layers.real.occluder_indirect(0, 0), indirect_rate, 1e-6);
    EXPECT_GT(shadow_rate, 1);
}

TEST(TwoModeSampler, OccludersOfWeakLightAndAtTheFloorDoNotNarrowTheFilter) {
    RealGeometry real = no_real_geometry();
    real.primary = [](const RayPacket&, const auto&) {
        RealPrimaryHits hits;
        hits.pixel.fill({2, glm::vec3(0), glm::vec3(0, 1, 0)});
        return hits;
    };
    real.distances = [](const RayPacket&) {
        DistancePacket d;
        d.fill(1e-3f);
        return d;
    };
    const EmbreeScene no_objects;
    const EnvironmentSampler sky = half_environment(0.01f, 1);  // light from below does not matter
    SamplingSettings settings = with_samples({}, 64);
    const auto rate = [&] {
        return sample_two_modes({lens_of(1, 1, 1), view, real, no_objects, sky}, settings, 0)
            .layers.real.occluder_direct(0, 0);
    };
    settings.ignored_luminance = 0.1f;
    EXPECT_EQ(rate(), 0);
    settings.ignored_luminance = 0.001f;
    // 2 % of the depth 2 is the nearest that counts; the steepest of some samples lies above 0.5
    EXPECT_LE(rate(), 1 / 0.04f);
}

TEST(TwoModeSampler, TheNearerSurfaceHidesTheOtherBeyondTheTolerance) {
    const auto share_of_real = [](float virtual_depth, float tolerance) {
        std::vector<SceneObject> objects{
            mesh_object(quad({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}), Diffuse{}, true),
            mesh_object(quad({-1, -1, -virtual_depth}, {2, 0, 0}, {0, 2, 0}), Diffuse{})};
        SamplingSettings settings;
        settings.depth_tolerance = tolerance;
        return sample_scene(PlacedScene(std::move(objects)), constant_environment(1),
                            lens_of(1, 1, 100), look_at({0, 0, 0}, {0, 0, -1}), settings)
            .layers.m(0, 0);
    };
    EXPECT_EQ(share_of_real(1.9f, 0), 0);
    EXPECT_EQ(share_of_real(2.1f, 0), 1);
    EXPECT_EQ(share_of_real(2.1f, 0.1f), 0);  // 5 % behind, 10 % tolerated
    EXPECT_EQ(share_of_real(2.5f, 0.1f), 1);
}

TEST(TwoModeSampler, NoLightReachesVirtualObjectsInAClosedRealRoom) {
    const PlacedScene scene(
        {mesh_object(cube_mesh(3), Diffuse{Rgb(0.9f)}, true),
         sphere_object({0, 0.3, 0}, 0.5f, Phong{Rgb(0.4f), Rgb(0.5f), 20}),
         sphere_object({1, 0.3, 0}, 0.4f, Ggx{Rgb(1), glm::vec2(0.6f), 1, nullptr})});
    const NoisyLayers layers =
        sample_scene(scene, constant_environment(100), lens_of(16, 12, 12), view, {}).layers;
    const Image<Rgb> nothing(16, 12, Rgb(0));
    for (const Irradiance& e : {layers.direct, layers.indirect}) {
        EXPECT_EQ(e.e_r.pixels, nothing.pixels);
        EXPECT_EQ(e.e_rv_real.pixels, nothing.pixels);
        EXPECT_EQ(e.e_rv_virtual.pixels, nothing.pixels);
    }
    EXPECT_EQ(layers.s_rv.pixels, nothing.pixels);
}

TEST(TwoModeSampler, AReceiverTellsWhatItIs) {
    const PlacedScene scene(
        {real_floor(), sphere_object({0, 0.3, 0}, 0.3f, Phong{Rgb(0.1f), Rgb(0.5f), 64})});
    const NoisyLayers layers =
        sample_scene(scene, constant_environment(1), lens_of(40, 30, 40), view, {}).layers;
    const auto centre =
        nearest_pixel(layers.lens, project(layers.lens, inverse(view) * glm::dvec3(0, 0.3, 0)));
    ASSERT_TRUE(centre);
    const auto [x, y] = std::pair{centre->x, centre->y};
    EXPECT_EQ(layers.virtual_.object(x, y), 2U);  // one more than its index in the scene
    EXPECT_EQ(layers.real.object(x, y), 0U);
    EXPECT_EQ(layers.m(x, y), 0);
    EXPECT_NEAR(glm::length(layers.virtual_.position(x, y) - glm::vec3(0, 0.3f, 0)), 0.3, 0.02);
    EXPECT_NEAR(layers.glossy_bandwidth(x, y), 14.6, 0.05);
    EXPECT_EQ(layers.real.object(1, 28), 1U);
    EXPECT_TRUE(near(layers.real.normal(1, 28), {0, 1, 0}, 1e-6));
    EXPECT_NEAR(layers.real.position(1, 28).y, 0, 1e-5);
}

}  // namespace
}  // namespace inlay::test
