// The difference form has the expectation of the two modes' samples, and closed forms where known.
#include "render/trace/change_estimator.h"

#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <vector>

namespace inlay::test {
namespace {

constexpr double pi = 3.14159265358979323846;

struct Eye {
    Lens lens = telescope(4, 4);  // all pixels see the same point
    SamplingSettings settings{};
};

SceneObject real_patch() { return mesh_object(floor_mesh(4e-3f), Diffuse{Rgb(0.5f)}, true); }

Pose from_the_side() { return look_at({2, 0.6, 0}, {0, 0, 0}); }

struct Changes {
    RunningMean direct, indirect, e_r;
};

/// Frames, not pixels, are the independent values: those of a frame share their light nets.
Changes changes_of(const PlacedScene& scene, const EnvironmentSampler& light, Estimator estimator,
                   int frames, const Eye& eye = {}) {
    SamplingSettings settings = eye.settings;
    settings.estimator = estimator;
    Changes changes;
    for (int frame = 0; frame < frames; ++frame) {
        const NoisyLayers layers =
            sample_scene(scene, light, eye.lens, from_the_side(), settings, std::uint32_t(frame))
                .layers;
        double direct = 0, indirect = 0, e_r = 0;
        for (std::size_t i = 0; i < layers.m.pixels.size(); ++i) {
            direct += double(layers.direct.e_rv_real.pixels[i].g - layers.direct.e_r.pixels[i].g);
            indirect +=
                double(layers.indirect.e_rv_real.pixels[i].g - layers.indirect.e_r.pixels[i].g);
            e_r += double(layers.direct.e_r.pixels[i].g + layers.indirect.e_r.pixels[i].g);
        }
        const double n = double(layers.m.pixels.size());
        changes.direct.add(direct / n);
        changes.indirect.add(indirect / n);
        changes.e_r.add(e_r / n);
    }
    return changes;
}

/// Whether two means agree (Welch's test, many values).
::testing::AssertionResult agree(const RunningMean& a, const RunningMean& b) {
    const double error = std::hypot(a.standard_error(), b.standard_error());
    if (error == 0) return plausible(a.mean == b.mean ? 1 : 0);
    return plausible(normal_p_value((a.mean - b.mean) / error))
           << "; " << a.mean << " +- " << a.standard_error() << " against " << b.mean << " +- "
           << b.standard_error();
}

/// The sphere covers the share (R / h)^2 of the point's cosine-weighted hemisphere.
TEST(DifferenceForm, AVirtualSphereTakesItsFormFactorAndReturnsItsAlbedo) {
    const double radius = 0.4, height = 0.8, covered = radius * radius / (height * height);
    const double albedo = 0.7;
    const PlacedScene scene(
        {real_patch(), sphere_object({0, height, 0}, float(radius), Diffuse{Rgb(float(albedo))})});
    const Changes c = changes_of(scene, constant_environment(1), Estimator::difference, 400);
    EXPECT_TRUE(has_mean(c.direct, -pi * covered));
    EXPECT_TRUE(has_mean(c.indirect, pi * albedo * covered));
    EXPECT_TRUE(has_mean(c.e_r, pi));
}

struct ChangeCase {
    const char* name;
    std::vector<SceneObject> objects;  // beside the real patch
};

std::vector<ChangeCase> change_cases() {
    const Diffuse chalk{Rgb(0.7f, 0.5f, 0.3f)};
    SceneObject wall = mesh_object(quad({-0.5f, 0, -0.6f}, {0, 1, 0}, {1, 0, 0}), chalk, true);
    std::vector<SceneObject> crowd;
    for (int i = 0; i < 40; ++i)
        crowd.push_back(
            sphere_object({0.6 * std::cos(i), 0.15 + 0.02 * i, 0.6 * std::sin(i)}, 0.05f, chalk));
    const SceneObject plate =
        mesh_object(quad({-3, 0.7f, 3}, {6, 0, 0}, {0, 0, -6}), chalk);  // larger than the sky
    const SceneObject needle =
        mesh_object(quad({0.2f, 0, 0}, {0.01f, 0, 0}, {0, 1.5f, 0.3f}), chalk);
    const SceneObject around = mesh_object(cube_mesh(0.9f), chalk);  // its bound holds the point
    const SceneObject behind = sphere_object({0, 0.4, -1.2}, 0.3f, chalk);
    const SceneObject glossy = sphere_object({0.3, 0.3, 0}, 0.2f, Phong{Rgb(0.2f), Rgb(0.6f), 30});
    return {{"many small ones", crowd},
            {"a plate overhead and a real wall", {plate, wall}},
            {"a needle", {needle}},
            {"a bound around the point", {around}},
            {"behind a real wall", {behind, wall}},
            {"glossy", {glossy, wall}}};
}

TEST(DifferenceForm, AgreesWithTheTwoModesWhateverTheObjectsAndTheLight) {
    const std::vector<EnvironmentSampler> lights{
        environment_of(lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2))),
        environment_of(hot_pixel_map(20, 4, 800, 0.3f))};
    for (const ChangeCase& c : change_cases()) {
        std::vector<SceneObject> objects = c.objects;
        objects.push_back(real_patch());
        const PlacedScene scene(objects);
        for (const EnvironmentSampler& light : lights) {
            const Changes apart = changes_of(scene, light, Estimator::difference, 300);
            const Changes together = changes_of(scene, light, Estimator::two_mode, 300);
            EXPECT_TRUE(agree(apart.direct, together.direct)) << c.name;
            EXPECT_TRUE(agree(apart.indirect, together.indirect)) << c.name;
            EXPECT_TRUE(agree(apart.e_r, together.e_r)) << c.name;
        }
    }
}

/// Pixels of .1 m: in some of them the camera's rays land on real and on virtual surfaces, on a
/// floor and on a table of the same normal above it, or further apart than the balls are wide; and
/// some real surfaces only the rays meet that look for silhouettes.
TEST(DifferenceForm, AgreesWherePixelsSeeMoreThanAPoint) {
    const Diffuse chalk{Rgb(0.7f, 0.5f, 0.3f)};
    std::vector<SceneObject> objects{
        mesh_object(floor_mesh(3), chalk, true),
        mesh_object(quad({-0.1f, 0.25f, 0.3f}, {0.45f, 0, 0}, {0, 0, -0.5f}), chalk, true),
        sphere_object({0.1, 0.1, -0.35}, 0.1f, chalk), sphere_object({0, 0.35, 0.1}, 0.1f, chalk)};
    for (int i = 0; i < 6; ++i)
        objects.push_back(sphere_object({0.1 * i - 0.2, 0.02, 0.3}, 0.015f, chalk));
    const PlacedScene scene(objects);
    const EnvironmentSampler light =
        environment_of(lobe_map(glm::normalize(glm::dvec3(1, 2, 0.5)), 10, 0.2f, Rgb(4, 3, 2)));
    SamplingSettings usual, few, many;
    few.primary = 3, few.secondary = 2, few.virtual_repeats = 1, few.coverage = 0;
    many.primary = 10, many.secondary = 1, many.virtual_repeats = 1, many.coverage = 0;
    for (const SamplingSettings& settings : {usual, few, many}) {
        const Eye eye{lens_of(8, 8, 20), settings};
        const Changes apart = changes_of(scene, light, Estimator::difference, 150, eye);
        const Changes together = changes_of(scene, light, Estimator::two_mode, 150, eye);
        EXPECT_TRUE(agree(apart.direct, together.direct)) << settings.primary;
        EXPECT_TRUE(agree(apart.indirect, together.indirect)) << settings.primary;
        EXPECT_TRUE(agree(apart.e_r, together.e_r)) << settings.primary;
    }
}

/// Half of the sphere's shadow share per sample is what a mean of 16 hits and misses strays by;
/// directions over its cone all hit.
TEST(DifferenceForm, StraysLessThanTheTwoModes) {
    const PlacedScene scene({real_patch(), sphere_object({0, 1.2, 0}, 0.3f, Diffuse{Rgb(0.5f)})});
    const EnvironmentSampler sky = constant_environment(1);
    const Changes apart = changes_of(scene, sky, Estimator::difference, 200);
    const Changes together = changes_of(scene, sky, Estimator::two_mode, 200);
    EXPECT_LT(apart.direct.variance(), 0.25 * together.direct.variance());
}

}  // namespace
}  // namespace inlay::test
