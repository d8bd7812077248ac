// Placement on analytic planes, and motion between keyframes.
#include "render/scene/place_object.h"

#include "recordings/base/check.h"
#include "recordings/base/random.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace inlay {
namespace {

using std::numbers::pi;

const Lens lens{320, 240, 290, 290, 159.5, 119.5};

/// A camera 1.2 m above the plane y = 0 of a y-up world, looking down by 35 degrees.
Pose camera_above_floor() {
    const double a = 35 * pi / 180;
    const glm::dvec3 z{0, -std::sin(a), -std::cos(a)}, x{1, 0, 0};
    return {glm::dmat3(x, glm::cross(z, x), z), {0.3, 1.2, 2.0}};
}

/// The floor as that camera measures it, with noise along the ray of `sigma` m at most.
SurfaceMap floor_map(double sigma = 0) {
    const Pose world_from_camera = camera_above_floor();
    SurfaceMap map = empty_surface_map(lens, world_from_camera);
    const glm::dvec3 up_camera = inverse(world_from_camera).rotation * glm::dvec3(0, 1, 0);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            const glm::dvec3 ray = unproject(lens, {x, y});
            const double z = -1.2 / glm::dot(ray, up_camera);
            if (z <= 0 || z > 8) continue;
            const SampleKey key{1, 0, std::uint32_t(y * lens.width + x), 0};
            map.position(x, y) = glm::vec3(ray * (z + sigma * (2 * uniform(key, 0) - 1)));
            map.normal(x, y) = glm::vec3(up_camera);
            map.confidence(x, y) = 1;
        }
    }
    return map;
}

const glm::dvec3 up(0, 1, 0);

glm::dvec3 base_of(const glm::dmat4& m) { return glm::dvec3(m[3]); }

TEST(PlaceOnSurface, StandsOnTheFloorUnderThePixelAndFacesTheCamera) {
    const SurfaceMap map = floor_map();
    for (const glm::ivec2 pixel :
         {glm::ivec2(160, 120), glm::ivec2(40, 200), glm::ivec2(300, 90)}) {
        const glm::dmat4 m = place_on_surface({0, pixel}, map, up, "cup");
        EXPECT_NEAR(m[3].y, 0, 1e-6);  // float positions
        const glm::dvec2 seen = project(lens, inverse(map.world_from_camera) * base_of(m));
        EXPECT_NEAR(seen.x, pixel.x, 1e-3);
        EXPECT_NEAR(seen.y, pixel.y, 1e-3);
        const glm::dmat3 axes(m);
        EXPECT_LT(glm::length(axes[1] - up), 1e-12);
        EXPECT_NEAR(glm::determinant(axes), 1, 1e-12);
        glm::dvec3 to_camera = map.world_from_camera.translation - base_of(m);
        to_camera.y = 0;
        EXPECT_NEAR(glm::dot(axes[2], glm::normalize(to_camera)), 1, 1e-12);
    }
}

TEST(PlaceOnSurface, TurnsCounterClockwiseSeenFromAbove) {
    const SurfaceMap map = floor_map();
    const glm::dmat3 straight(place_on_surface({0, {160, 120}}, map, up, "cup"));
    const glm::dmat3 turned(place_on_surface({0, {160, 120}, 90}, map, up, "cup"));
    EXPECT_LT(glm::length(turned[2] - straight[0]), 1e-12);  // +z goes where +x was
}

TEST(PlaceOnSurface, AveragesTheNoiseOfTheDepth) {
    const double sigma = 0.01;
    const SurfaceMap map = floor_map(sigma);
    const glm::dmat4 m = place_on_surface({0, {160, 120}, 0, true}, map, up, "cup");
    // Uniform noise of 10 mm over hundreds of points: an error of 1 mm would be 3 sigma and more.
    EXPECT_NEAR(m[3].y, 0, 0.001);
    EXPECT_GT(m[1].y, std::cos(2 * pi / 180));
}

TEST(PlaceOnSurface, IgnoresABoxBesideThePixel) {
    SurfaceMap map = floor_map();
    for (int y = 90; y < 150; ++y)  // a wall 0.3 m in front of the floor, 3 px from the pixel
        for (int x = 163; x < 200; ++x)
            map.position(x, y) *= 0.75f;
    const glm::dmat4 m = place_on_surface({0, {160, 120}, 0, true}, map, up, "cup");
    EXPECT_NEAR(m[3].y, 0, 1e-4);  // outliers weigh nothing at all
    EXPECT_NEAR(m[1].y, 1, 1e-6);
}

TEST(PlaceOnSurface, BridgesAHoleOfFivePixelsAndNoMore) {
    SurfaceMap map = floor_map();
    const auto punch = [&](int radius) {
        for (int y = 120 - radius; y <= 120 + radius; ++y)
            for (int x = 160 - radius; x <= 160 + radius; ++x)
                map.position(x, y) = glm::vec3(0);
    };
    punch(4);
    const glm::dmat4 m = place_on_surface({0, {160, 120}}, map, up, "cup");
    EXPECT_NEAR(m[3].y, 0, 1e-5);
    const glm::dvec2 seen = project(lens, inverse(map.world_from_camera) * base_of(m));
    EXPECT_NEAR(seen.x, 160, 1e-2);  // the ray through the pixel asked for, not its neighbour's
    punch(5);
    EXPECT_THROW(place_on_surface({0, {160, 120}}, map, up, "cup"), Error);
    EXPECT_THROW(place_on_surface({0, {320, 120}}, map, up, "cup"), Error);
}

TEST(PlaceOnSurface, HasAFacingWhenTheCameraLooksStraightDown) {
    const Pose down{{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {0, 1, 0}};  // z = -y of the world
    SurfaceMap map = empty_surface_map(lens, down);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = 0; x < lens.width; ++x) {
            map.position(x, y) = glm::vec3(unproject(lens, {x, y}));
            map.normal(x, y) = {0, 0, -1};
        }
    }
    Lens centred = lens;
    centred.cx = 160, centred.cy = 120;
    map.lens = centred;
    const glm::dmat3 axes(place_on_surface({0, {160, 120}}, map, up, "cup"));
    EXPECT_NEAR(glm::determinant(axes), 1, 1e-9);
    EXPECT_GT(axes[2].z, 0.99);  // towards the bottom of the image
}

TEST(ResolvePlacements, PutsMotionIntoTheBaseFrame) {
    SceneFile scene;
    SceneEntry entry;
    entry.object.name = "ball";
    entry.object.parts.push_back({SphereShape{0.1f}, Diffuse{}});
    entry.base_from_object = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0.1, 0));
    const glm::dmat4 aside = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0, 0));
    entry.object.motion = {{0, entry.base_from_object}, {1, aside * entry.base_from_object}};
    entry.placement = Placement{3, {160, 120}, 0, false};
    scene.entries.push_back(entry);
    int asked = 0;
    const VirtualScene resolved = resolve_placements(
        scene,
        [&](int frame) {
            EXPECT_EQ(frame, 3);
            ++asked;
            return floor_map();
        },
        up);
    EXPECT_EQ(asked, 1);
    ASSERT_EQ(resolved.objects.size(), 1u);
    const glm::dvec3 start = base_of(transform_at(resolved.objects[0], -1));
    const glm::dvec3 end = base_of(transform_at(resolved.objects[0], 2));
    EXPECT_NEAR(start.y, 0.1, 1e-6);  // a sphere's radius above the floor
    EXPECT_NEAR(end.y, 0.1, 1e-6);
    EXPECT_NEAR(glm::length(end - start), 0.2, 1e-9);
}

glm::dmat4 key_transform(double angle, const glm::dvec3& scale, const glm::dvec3& at) {
    return glm::scale(glm::rotate(glm::translate(glm::dmat4(1.0), at), angle,
                                  glm::normalize(glm::dvec3(1, 2, 0))),
                      scale);
}

double difference(const glm::dmat4& a, const glm::dmat4& b) {
    double worst = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j)
            worst = std::max(worst, std::abs(a[i][j] - b[i][j]));
    return worst;
}

TEST(TransformAt, InterpolatesPositionScaleAndRotation) {
    SceneObject object;
    object.motion = {{1, key_transform(0.2, {1, 1, 1}, {0, 0, 0})},
                     {3, key_transform(1.4, {2, 3, 1}, {4, -2, 1})}};
    EXPECT_LT(
        difference(transform_at(object, 1.5), key_transform(0.5, {1.25, 1.5, 1}, {1, -0.5, 0.25})),
        1e-12);  // rounding
}

TEST(TransformAt, IsConstantOutsideAndExactAtTheKeys) {
    SceneObject object;
    object.motion = {{1, key_transform(0.2, {1, 1, 1}, {0, 0, 0})},
                     {3, key_transform(1.4, {2, 3, 1}, {4, -2, 1})},
                     {4, key_transform(-1, {1, 1, 1}, {0, 1, 1})}};
    EXPECT_EQ(transform_at(object, -5), object.motion[0].world_from_object);
    EXPECT_EQ(transform_at(object, 9), object.motion[2].world_from_object);
    for (const MotionKey& key : object.motion)
        EXPECT_EQ(transform_at(object, key.time), key.world_from_object);
    EXPECT_LT(difference(transform_at(object, 3 - 1e-9), object.motion[1].world_from_object), 1e-7);
}

TEST(TransformAt, TakesTheShorterArc) {
    SceneObject object;
    object.motion = {{0, key_transform(-3.0, {1, 1, 1}, {0, 0, 0})},
                     {1, key_transform(3.0, {1, 1, 1}, {0, 0, 0})}};
    EXPECT_LT(difference(transform_at(object, 0.5), key_transform(pi, {1, 1, 1}, {0, 0, 0})), 1e-9);
}

}  // namespace
}  // namespace inlay
