// ModelLight: E_R on the vertices of a mesh, against E_R as pixels sample it for themselves.
#include "render/trace/model_light.h"

#include "tests/support/matchers.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay::test {
namespace {

/// A plate of n x n squares with vertices of its own, from `corner` along `a` and `b` (m).
void append_plate(TriangleMesh& mesh, const glm::vec3& corner, const glm::vec3& a,
                  const glm::vec3& b, int n) {
    const auto first = std::uint32_t(mesh.positions.size());
    const auto across = std::uint32_t(n + 1);
    for (int i = 0; i <= n; ++i) {
        for (int j = 0; j <= n; ++j) {
            mesh.positions.push_back(corner + (float(j) * a + float(i) * b) / float(n));
            mesh.normals.push_back(glm::normalize(glm::cross(a, b)));
            mesh.colors.emplace_back(0.4f, 0.3f, 0.2f);
        }
    }
    for (std::uint32_t i = 0; i + 1 < across; ++i) {
        for (std::uint32_t j = 0; j + 1 < across; ++j) {
            const std::uint32_t at = first + i * across + j;
            mesh.triangles.emplace_back(at, at + 1, at + across);
            mesh.triangles.emplace_back(at + 1, at + across + 1, at + across);
        }
    }
}

/// A floor with a wall behind it, 2 m wide, in squares of 2 cm, as a fused model would be.
std::shared_ptr<const EmbreeScene> floor_and_wall() {
    auto mesh = std::make_shared<TriangleMesh>();
    append_plate(*mesh, {-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 100);
    append_plate(*mesh, {-1, 0, -1}, {2, 0, 0}, {0, 1, 0}, 100);
    return std::make_shared<const EmbreeScene>(EmbreeSceneCache().place(std::move(mesh)));
}

constexpr float offset = 0.01f;  // m

/// The mesh as rays and camera meet it; what the camera sees lies `gap` (m) in front of it.
RealGeometry seen(const EmbreeScene& mesh, float gap = 0) {
    RealGeometry real = mesh_alone(mesh, offset);
    real.primary = [&mesh, gap](const RayPacket& rays, const auto&) {
        RealPrimaryHits result;
        const HitPacket hits = mesh.intersect(rays);
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (!hits[i].hit()) continue;
            const SurfacePoint point =
                mesh.surface_point(hits[i], rays.origin[i], rays.direction[i]);
            result.pixel[i] = {hits[i].distance, point.position + gap * point.shading_normal,
                               point.shading_normal};
        }
        return result;
    };
    return real;
}

const Pose one_view = look_at({0.3, 1, 1.6}, {0, 0.1, -0.3});
const Pose other_view = look_at({-0.6, 0.8, 1.2}, {0.1, 0.1, -0.5});

/// A ball on the floor in front of the wall, sampled by the difference form.
struct Room {
    std::shared_ptr<const EmbreeScene> mesh = floor_and_wall();
    EnvironmentSampler sky = constant_environment(1);
    SamplingSettings settings = difference(16);
    PlacedScene objects{{sphere_object({0, 0.15, -0.4}, 0.15f, Diffuse{Rgb(0.5f)})}};
    std::unique_ptr<ModelLight> light;

    static SamplingSettings difference(int samples) {
        SamplingSettings settings = with_samples({}, samples);
        settings.estimator = Estimator::difference;
        settings.virtual_repeats = 1;
        return settings;
    }

    void keep() { light = make_model_light(mesh, sky, settings, offset); }

    TwoModeResult sample(const Pose& view, float gap = 0) const {
        const RealGeometry real = seen(*mesh, gap);
        return sample_two_modes(
            {lens_of(48, 36, 40), view, real, objects.virtual_, sky, light.get()}, settings, 3);
    }
};

glm::dvec3 mean_of(const Image<Rgb>& image) {
    glm::dvec3 sum(0);
    for (const Rgb& value : image.pixels)
        sum += glm::dvec3(value);
    return sum / double(image.pixels.size());
}

/// 2 % of the mean: 1728 pixels of 256 samples and some 5000 vertices of 64 are known to .1 %; what
/// is left is the light in the corner, which is straight between vertices 2 cm apart.
TEST(ModelLight, IsTheLightThatPixelsSampleForThemselves) {
    Room room;
    room.settings = Room::difference(256);
    const NoisyLayers sampled = room.sample(one_view).layers;
    room.settings.gathered = 1024;  // 64 where nothing changes
    room.keep();
    const NoisyLayers kept = room.sample(one_view).layers;
    for (int c = 0; c < 3; ++c) {
        const double direct = mean_of(sampled.direct.e_r)[c];
        const double indirect = mean_of(sampled.indirect.e_r)[c];
        EXPECT_NEAR(mean_of(kept.direct.e_r)[c], direct, 0.02 * direct);
        EXPECT_NEAR(mean_of(kept.indirect.e_r)[c], indirect, 0.02 * indirect);
        EXPECT_GT(indirect, 0.01);
    }
}

TEST(ModelLight, LeavesTheChangeAsItIs) {
    Room room;
    const NoisyLayers sampled = room.sample(one_view).layers;
    room.keep();
    const NoisyLayers kept = room.sample(one_view).layers;
    EXPECT_TRUE(same_bytes(sampled.change_rates.direct, kept.change_rates.direct));
    for (std::size_t i = 0; i < kept.m.pixels.size(); ++i) {
        const Rgb a = sampled.direct.e_rv_real.pixels[i] - sampled.direct.e_r.pixels[i];
        const Rgb b = kept.direct.e_rv_real.pixels[i] - kept.direct.e_r.pixels[i];
        EXPECT_NEAR(luminance(a), luminance(b), 1e-5);  // sums of numbers up to 4, rounded
    }
}

TEST(ModelLight, DoesNotDependOnTheFramesBefore) {
    Room room, fresh;
    room.keep();
    fresh.keep();
    room.sample(one_view);
    const NoisyLayers after = room.sample(other_view).layers;
    const NoisyLayers alone = fresh.sample(other_view).layers;
    EXPECT_TRUE(same_bytes(after.direct.e_r, alone.direct.e_r));
    EXPECT_TRUE(same_bytes(after.indirect.e_r, alone.indirect.e_r));
    EXPECT_TRUE(same_bytes(after.direct.e_rv_real, alone.direct.e_rv_real));
    EXPECT_TRUE(same_bytes(after.real.occluder_direct, alone.real.occluder_direct));
}

TEST(ModelLight, DoesNotDependOnThreadsOrOnTheSamplesOfPixels) {
    Room one, many;
    one.keep();
    many.keep();
    set_thread_count(1);
    const NoisyLayers by_one = one.sample(one_view).layers;
    set_thread_count(0);
    many.settings.secondary = 8;
    many.sample(other_view);
    many.settings.secondary = 4;
    const NoisyLayers by_many = many.sample(one_view).layers;
    EXPECT_TRUE(same_bytes(by_one.direct.e_r, by_many.direct.e_r));
    EXPECT_TRUE(same_bytes(by_one.indirect.e_rv_real, by_many.indirect.e_rv_real));
}

/// More samples per pixel than per vertex: E_R has to converge with them.
TEST(ModelLight, IsNotTakenWherePixelsHaveMoreSamples) {
    Room room;
    room.settings = Room::difference(128);
    const NoisyLayers sampled = room.sample(one_view).layers;
    room.keep();
    EXPECT_TRUE(same_bytes(sampled.direct.e_r, room.sample(one_view).layers.direct.e_r));
    EXPECT_EQ(keep_model_light(room.light, room.mesh, room.sky, room.settings, offset), nullptr);
}

TEST(ModelLight, IsGatheredOnce) {
    Room room;
    room.keep();
    const TwoModeResult first = room.sample(one_view), second = room.sample(one_view);
    room.light = nullptr;
    const TwoModeResult without = room.sample(one_view);
    EXPECT_GT(first.gathering.real_shadow, 0u);
    EXPECT_GT(first.gathering.real_indirect, first.gathering.real_shadow);  // half look below
    EXPECT_EQ(second.gathering.real_shadow + second.gathering.real_indirect, 0u);
    EXPECT_EQ(without.gathering.real_indirect, 0u);
    EXPECT_LT(second.rays.real_indirect, without.rays.real_indirect);
    EXPECT_LT(second.rays.real_shadow, without.rays.real_shadow);
    EXPECT_EQ(second.rays.virtual_shadow, without.rays.virtual_shadow);
}

TEST(ModelLight, WhereTheModelHasAnotherSurfacePixelsSampleForThemselves) {
    Room room;
    const NoisyLayers sampled = room.sample(one_view, 3 * offset).layers;
    room.keep();
    const NoisyLayers kept = room.sample(one_view, 3 * offset).layers;
    EXPECT_TRUE(same_bytes(sampled.direct.e_r, kept.direct.e_r));
    EXPECT_TRUE(same_bytes(sampled.indirect.e_r, kept.indirect.e_r));
}

TEST(ModelLight, FollowsALightThatChanges) {
    Room room;
    room.keep();
    const ModelLight* before = room.light.get();
    const auto kept = [&](const EnvironmentSampler& sky) {
        return keep_model_light(room.light, room.mesh, sky, room.settings, offset);
    };
    EXPECT_EQ(kept(room.sky), before);
    EXPECT_EQ(kept(constant_environment(1)), before);  // the same light
    const NoisyLayers dim = room.sample(one_view).layers;
    room.sky = constant_environment(2);
    kept(room.sky);
    const NoisyLayers bright = room.sample(one_view).layers;
    for (std::size_t i = 0; i < dim.m.pixels.size(); ++i)
        EXPECT_EQ(2.0f * dim.direct.e_r.pixels[i], bright.direct.e_r.pixels[i]);
}

TEST(ModelLight, IsMadeAnewForAnotherModelOrOtherSettings) {
    Room room;
    room.keep();
    room.light->gathered[0].known[0] = 1;
    const auto is_new = [&] { return room.light->gathered[0].known[0] == 0; };
    keep_model_light(room.light, room.mesh, room.sky, room.settings, offset);
    EXPECT_FALSE(is_new());
    SamplingSettings shared = room.settings;
    shared.estimator = Estimator::two_mode;
    EXPECT_EQ(keep_model_light(room.light, room.mesh, room.sky, shared, offset), nullptr);
    EXPECT_FALSE(is_new());
    keep_model_light(room.light, floor_and_wall(), room.sky, room.settings, offset);
    EXPECT_TRUE(is_new());
    room.light->gathered[0].known[0] = 1;
    ++room.settings.seed;
    keep_model_light(room.light, room.light->mesh, room.sky, room.settings, offset);
    EXPECT_TRUE(is_new());
}

TEST(ModelLight, NeedsNormals) {
    auto bare = std::make_shared<TriangleMesh>(floor_mesh(1));
    const auto mesh = std::make_shared<const EmbreeScene>(EmbreeSceneCache().place(bare));
    EXPECT_EQ(make_model_light(mesh, constant_environment(1), {}, offset), nullptr);
    EXPECT_EQ(make_model_light(nullptr, constant_environment(1), {}, offset), nullptr);
    EXPECT_EQ(make_model_light(std::make_shared<const EmbreeScene>(), constant_environment(1), {},
                               offset),
              nullptr);
}

}  // namespace
}  // namespace inlay::test
