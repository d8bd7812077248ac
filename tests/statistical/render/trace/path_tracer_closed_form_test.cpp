// The path tracer against closed forms: furnaces, convex objects, a cavity, one bright texel.
#include "render/scatter/bsdf.h"
#include "tests/support/mean_test.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

namespace inlay::test {
namespace {

/// Where a ray is traced from and to; all lanes and samples follow it.
struct TestRay {
    glm::vec3 origin, target;
};

/// Mean red radiance of 16 x `packets` paths along one ray.
RunningMean mean_radiance(const EmbreeScene& scene, const EnvironmentSampler& environment,
                          const TestRay& ray, int packets, const PathSettings& settings = {}) {
    RunningMean result;
    for (int s = 0; s < packets; ++s) {
        const RadiancePacket radiance = paths_along(
            scene, environment, ray.origin, ray.target - ray.origin, std::uint32_t(s), settings);
        for (const Rgb& r : radiance)
            result.add(r.r);
    }
    return result;
}

/// Looks at the origin from `theta_deg` off +y, towards +z.
TestRay looking_down(double theta_deg) {
    const double theta = theta_deg * std::numbers::pi / 180;
    return {glm::vec3(0, 2 * std::cos(theta), 2 * std::sin(theta)), glm::vec3(0)};
}

TEST(PathTracer, AWhiteSphereVanishesInAFurnace) {
    const PlacedScene scene({sphere_object({0, 0, 0}, 1, Diffuse{Rgb(1)})});
    const EnvironmentSampler furnace = constant_environment(1);
    for (const float offset : {0.0f, 0.5f, 0.9f, 0.999f}) {
        const TestRay ray{{offset, 0, 5}, {offset, 0, 0}};
        EXPECT_TRUE(has_mean(mean_radiance(scene.all, furnace, ray, 500), 1)) << offset;
    }
}

TEST(PathTracer, APlaneInAFurnaceShowsItsAlbedo) {
    const EnvironmentSampler furnace = constant_environment(1);
    for (const float albedo : {0.0f, 0.2f, 0.8f, 1.0f}) {
        const PlacedScene scene({mesh_object(floor_mesh(10), Diffuse{Rgb(albedo)})});
        EXPECT_TRUE(has_mean(mean_radiance(scene.all, furnace, looking_down(50), 500), albedo));
    }
}

/// Colors that are linear in x over a floor of half-width 1: its triangles show them unchanged.
TEST(PathTracer, APlaneInAFurnaceShowsTheColorsOfItsVertices) {
    const EnvironmentSampler furnace = constant_environment(1);
    TriangleMesh floor = floor_mesh(1);
    for (const glm::vec3& p : floor.positions)
        floor.colors.emplace_back(0.5f + 0.3f * p.x);
    const PlacedScene scene({mesh_object(floor, Diffuse{Rgb(1), nullptr, true})});
    for (const float x : {-0.9f, 0.1f, 0.7f}) {
        const TestRay ray{{x, 1, 0.3f}, {x, 0, 0.3f}};
        EXPECT_TRUE(has_mean(mean_radiance(scene.all, furnace, ray, 500), 0.5 + 0.3 * x)) << x;
    }
}

struct AlbedoCase {
    glm::vec2 alpha;
    double theta_deg, phi_deg, albedo;
};

/// Directional albedos of GGX with F = 1, by quadrature. The tangents at normal +y are those of
/// basis_about: the view turns by phi about the normal.
TEST(PathTracer, APlaneOfMetalInAFurnaceShowsItsDirectionalAlbedo) {
    const EnvironmentSampler furnace = constant_environment(1);
    const glm::mat3 tangents = basis_about({0, 1, 0});
    for (const AlbedoCase& c :
         {AlbedoCase{{0.1f, 0.1f}, 0, 0, 0.98831}, AlbedoCase{{0.5f, 0.5f}, 60, 0, 0.69825},
          AlbedoCase{{1, 1}, 80, 0, 0.66819}, AlbedoCase{{1, 0.1f}, 80, 0, 0.80350},
          AlbedoCase{{1, 0.1f}, 80, 90, 0.51549}, AlbedoCase{{0.25f, 0.05f}, 45, 30, 0.93099}}) {
        const PlacedScene scene(
            {mesh_object(floor_mesh(100), Ggx{Rgb(1), glm::sqrt(c.alpha), 1, nullptr})});
        const double theta = c.theta_deg * std::numbers::pi / 180,
                     phi = c.phi_deg * std::numbers::pi / 180;
        const glm::vec3 viewer =
            tangents * glm::vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
        EXPECT_TRUE(
            has_mean(mean_radiance(scene.all, furnace, {viewer, {0, 0, 0}}, 1000), c.albedo))
            << "theta " << c.theta_deg << ", phi " << c.phi_deg;
    }
}

TEST(PathTracer, PhongAlongTheNormalLosesNothing) {
    const EnvironmentSampler furnace = constant_environment(1);
    for (const float n : {1.0f, 30.0f, 1000.0f}) {
        const PlacedScene scene({mesh_object(floor_mesh(10), Phong{Rgb(0.3f), Rgb(0.6f), n})});
        EXPECT_TRUE(has_mean(mean_radiance(scene.all, furnace, looking_down(0), 500), 0.9)) << n;
    }
}

/// A unit sphere open above: its inside sees the opening, a share f of the whole sphere, from
/// everywhere alike, hence radiosity B = a f / (1 - a (1 - f)).
TEST(PathTracer, ACavityHasTheRadiosityOfAnIntegratingSphere) {
    const double share = 0.25, albedo = 0.8;  // a rim at height 1 - 2 f cuts the share f off
    const PlacedScene scene(
        {mesh_object(bowl_mesh(1 - 2 * share, 128), Diffuse{Rgb(float(albedo))})});
    PathSettings settings;
    settings.max_vertices = 200;  // the energy beyond is below rounding
    const RunningMean m = mean_radiance(scene.all, constant_environment(1),
                                        {{0.1f, 3, 0}, {0.3f, -0.8f, 0.1f}}, 2000, settings);
    // 1e-3 of it: the opening and the wall are polyhedra of 128 rings
    const double expected = albedo * share / (1 - albedo * (1 - share));
    const double low = mean_p_value(m, expected * (1 - 1e-3));
    const double high = mean_p_value(m, expected * (1 + 1e-3));
    EXPECT_TRUE(plausible(std::max({low, high, mean_p_value(m, expected)})))
        << m.mean << " +- " << m.standard_error() << ", expected " << expected;
}

TEST(PathTracer, NoLightLeaksIntoAClosedRoom) {
    const PlacedScene scene({mesh_object(cube_mesh(1), Diffuse{Rgb(0.9f)})});
    for (const glm::vec3& target :
         {glm::vec3(1, 0.2f, 0.3f), {1, 0.999f, 0.998f}, {0.99f, -1, 0}}) {
        const RunningMean m =
            mean_radiance(scene.all, constant_environment(100), {{0, 0, 0}, target}, 100);
        EXPECT_EQ(m.mean, 0);
    }
}

/// Integral over a texel of a function of direction times radiance, by the midpoint rule.
double texel_integral(const Image<Rgb>& map, glm::ivec2 texel,
                      const std::function<double(const glm::vec3&)>& f) {
    constexpr int steps = 64;
    double sum = 0, weights = 0;
    for (int i = 0; i < steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const glm::dvec2 at{texel.x + (i + 0.5) / steps, texel.y + (j + 0.5) / steps};
            const double sine = std::sin(std::numbers::pi * at.y / map.height);
            sum += sine * f(glm::vec3(direction_from_texel(map, at)));
            weights += sine;
        }
    }
    return sum / weights * texel_solid_angle(map, texel.y) * map(texel.x, texel.y).r;
}

/// One texel of radiance 5e4: unbiased for surfaces that find it by chance and for those that must
/// be told where it is.
TEST(PathTracer, OneHotTexelIsNeitherLostNorCountedTwice) {
    const TestRay ray = looking_down(40);
    const ScatterFrame frame = scatter_frame({0, 1, 0}, glm::normalize(ray.origin));
    for (const glm::ivec2 texel : {glm::ivec2(0, 4), {16, 3}, {7, 0}, {0, 7}}) {
        const Image<Rgb> map = hot_pixel_map(texel.x, texel.y, 5e4f);
        const EnvironmentSampler environment = environment_of(map);
        for (const Material& material :
             {Material(Diffuse{Rgb(0.5f)}), Material(Phong{Rgb(0.2f), Rgb(0.5f), 20}),
              Material(Ggx{Rgb(0.9f), glm::vec2(0.4f), 1, nullptr})}) {
            const PlacedScene scene({mesh_object(floor_mesh(10), material)});
            const Bsdf bsdf = bsdf_at(material, {0, 0}, 1);
            const double expected = texel_integral(map, texel, [&](const glm::vec3& light) {
                const double cosine = std::max(0.0f, light.y);
                return bsdf.diffuse.r * cosine / std::numbers::pi +
                       double(eval_glossy(bsdf, frame, light).r);
            });
            EXPECT_TRUE(has_mean(mean_radiance(scene.all, environment, ray, 1000), expected))
                << "texel (" << texel.x << ", " << texel.y << ")";
        }
    }
}

}  // namespace
}  // namespace inlay::test
