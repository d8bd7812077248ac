#include "render/trace/map_primary.h"

#include "render/trace/landing.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

namespace inlay::test {
namespace {

const Lens lens{1, 1, 1, 1, 0, 0};
constexpr float near_z = 1, far_z = 3;

/// One pixel that looks along +z: a surface at 1 m, and right of x = `edge` px one at 3 m.
SurfaceMap split_pixel(float edge, bool far_known = true) {
    SurfaceMap map = empty_surface_map(lens, {});
    map.position(0, 0) = {0, 0, near_z};
    map.normal(0, 0) = {0, 0, -1};
    map.confidence(0, 0) = 1;
    map.split.number = Image<std::uint32_t>(1, 1, 1);
    map.split.second = {
        {far_known ? glm::vec3(0, 0, far_z) : glm::vec3(0), {0, 0, -1}, {1, 0}, edge}};
    return map;
}

/// Sixteen rays through the pixel, from its left border to its right one.
RayPacket rays_across() {
    RayPacket rays;
    for (int lane = 0; lane < packet_width; ++lane)
        rays.set(lane, glm::vec3(0),
                 glm::normalize(glm::vec3((float(lane) + 0.5f) / packet_width - 0.5f, 0, 1)));
    return rays;
}

TEST(MapPrimary, RaysBeyondTheEdgeMeetTheSecondSurface) {
    const SurfaceMap map = split_pixel(0.25f);  // a quarter of the pixel is right of it
    const RayPacket rays = rays_across();
    const RealPrimaryHits hits = map_primary(map, rays, {});
    EXPECT_EQ(hits.split, 0xf000U);
    for (std::size_t i = 0; i < packet_width; ++i) {
        EXPECT_NEAR(hits.pixel[i].position.z, near_z, 1e-6);  // rounding
        if (i >= 12) {
            EXPECT_NEAR(hits.ray[i].position.z, far_z, 1e-6);
        }
    }
}

/// Landings of the rays with a virtual wall at a depth; which of them are on it.
std::uint32_t on_virtual(const SurfaceMap& map, float virtual_z, int& real_near) {
    RealGeometry real = no_real_geometry();
    real.primary = [&map](const RayPacket& rays, const auto& pixels) {
        return map_primary(map, rays, pixels);
    };
    const PlacedScene scene(
        {mesh_object(quad({-9, -9, virtual_z}, {0, 18, 0}, {18, 0, 0}), Diffuse{})});
    const Landings landings = land(real, scene.virtual_, rays_across(), {}, 0);
    std::uint32_t lanes = 0;
    real_near = 0;
    for (std::size_t i = 0; i < packet_width; ++i) {
        if (landings[i].kind == LandingKind::on_virtual) lanes |= 1U << i;
        real_near += landings[i].kind == LandingKind::real && landings[i].position.z < 2;
    }
    return lanes;
}

TEST(MapPrimary, AVirtualWallShowsBesideAnEdgeOnlyBetweenTheTwoSurfaces) {
    const SurfaceMap map = split_pixel(0.25f);
    int near = 0;
    EXPECT_EQ(on_virtual(map, 0.5f, near), 0xffffU);  // before both
    EXPECT_EQ(on_virtual(map, 2, near), 0xf000U);     // between: where the far surface is seen
    EXPECT_EQ(near, 12);
    EXPECT_EQ(on_virtual(map, 4, near),
              0U);  // behind both: all light is gathered on the pixel's own
    EXPECT_EQ(near, 16);
    const SurfaceMap open = split_pixel(0.25f, false);  // nothing is known beyond the edge
    EXPECT_EQ(on_virtual(open, 4, near), 0xf000U);
}

}  // namespace
}  // namespace inlay::test
