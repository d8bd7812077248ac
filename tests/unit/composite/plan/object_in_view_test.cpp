// What an object may cover of a view: never less than it does, and not everything.
#include "composite/plan/object_in_view.h"

#include "composite/plan/scene_facts.h"
#include "recordings/base/pose.h"
#include "recordings/base/random.h"
#include "tests/support/tabletop.h"
#include "tests/support/test_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

const Lens straight{64, 48, 60, 60, 31.5, 23.5};
const Lens bent{64, 48, 60, -60, 30, 25, -0.25, 0.08, 0.01, 0.002, -0.003};
const Lens pincushion{64, 48, 60, 60, 31.5, 23.5, 0.4};  // borders bulge beyond the corners

ObjectBounds ball_bounds(double radius) {
    return {glm::dvec3(-radius), glm::dvec3(radius), radius};
}

glm::dmat4 moved_to(const glm::dvec3& centre) { return glm::translate(glm::dmat4(1), centre); }

/// A number in 0..1 of its own for each argument.
double number(std::uint32_t i, std::uint32_t which) { return uniform({3, 0, i, 0}, which); }

TEST(ObjectInView, WhatARayMeetsIsNeverOutOfView) {
    for (const Lens& lens : {straight, bent, pincushion}) {
        const ViewWindow window = view_window(lens);
        for (std::uint32_t i = 0; i < 20000; ++i) {
            const glm::dvec2 pixel{number(i, 0) * lens.width - 0.5,
                                   number(i, 1) * lens.height - 0.5};
            const double depth = std::pow(10.0, 4 * number(i, 2) - 2);
            const double radius = std::pow(10.0, 4 * number(i, 3) - 3);
            const glm::dvec3 met = depth * unproject(lens, pixel);
            const double turn = 6.28 * number(i, 4), height = 2 * number(i, 5) - 1;
            const double flat = std::sqrt(1 - height * height);
            const glm::dvec3 off{flat * std::cos(turn), flat * std::sin(turn), height};
            const ObjectInView seen = object_in_view(
                ball_bounds(radius), moved_to(met + radius * number(i, 6) * off), window);
            ASSERT_TRUE(seen.possible) << "pixel " << pixel.x << ", " << pixel.y;
            ASSERT_GE(seen.share_with_rim, seen.share_of_view);
        }
    }
}

TEST(ObjectInView, WhatLiesClearlyBesideOrBehindIsOut) {
    for (const Lens& lens : {straight, bent}) {
        const ViewWindow window = view_window(lens);
        const ObjectBounds bounds = ball_bounds(0.1);
        for (const glm::dvec3& beside :
             {glm::dvec3(3, 0, 1), glm::dvec3(-3, 0, 1), glm::dvec3(0, 3, 1), glm::dvec3(0, -3, 1)})
            EXPECT_FALSE(object_in_view(bounds, moved_to(beside), window).possible);
        EXPECT_FALSE(object_in_view(bounds, moved_to({0, 0, -0.2}), window).possible);
        EXPECT_FALSE(object_in_view(ball_bounds(1), moved_to({0, 0, -1.1}), window).possible);
        EXPECT_TRUE(object_in_view(bounds, moved_to({0, 0, -0.05}), window).possible);
    }
}

TEST(ObjectInView, TheEdgeOfTheImageIsFoundToAHundredthOfAPixel) {
    const ViewWindow window = view_window(straight);
    const double radius = 0.001;  // at 1 m: 0.06 px
    const auto possible = [&](double column) {
        const glm::dvec3 at = unproject(straight, {column, 20});
        return object_in_view(ball_bounds(radius), moved_to(at), window).possible;
    };
    EXPECT_TRUE(possible(-0.5 - 0.05));
    EXPECT_FALSE(possible(-0.5 - 0.08));
    EXPECT_TRUE(possible(63.5 + 0.05));
    EXPECT_FALSE(possible(63.5 + 0.08));
}

TEST(ObjectInView, ABallsSizeIsThatOfItsTangents) {
    const ViewWindow window = view_window(straight);
    const ObjectInView seen = object_in_view(ball_bounds(0.2), moved_to({0, 0, 1}), window);
    const double exact = 2 * 60 * std::tan(std::asin(0.2));
    // the margins of 0.2 % of the radius widen it a little
    EXPECT_GE(seen.size_px.x, exact);
    EXPECT_LT(seen.size_px.x, 1.01 * exact);
    EXPECT_NEAR(seen.share_of_view, exact * exact / (64 * 48), 0.02 * seen.share_of_view);
}

TEST(ObjectInView, ASinglePixelIsSeen) {
    const ViewWindow window = view_window(straight);
    const ObjectInView seen =
        object_in_view(ball_bounds(0.5 / 60 * 10), moved_to({0, 0, 10}), window);
    EXPECT_TRUE(seen.possible);
    EXPECT_NEAR(seen.size_px.x, 1, 0.01);
    EXPECT_NEAR(seen.share_of_view * 64 * 48, 1, 0.02);
}

TEST(ObjectInView, AnObjectAboutTheCameraFillsTheView) {
    const ViewWindow window = view_window(bent);
    const ObjectInView seen = object_in_view(ball_bounds(2), moved_to({0.1, 0, 0.5}), window);
    EXPECT_TRUE(seen.possible);
    EXPECT_EQ(seen.share_of_view, 1);
    EXPECT_TRUE(std::isinf(seen.size_px.x));
}

TEST(ObjectInView, WithoutASurfaceNothingIsSeen) {
    SceneObject nothing = test::mesh_object("nothing", {}, Rgb(0.5f), false);
    EXPECT_TRUE(bounds_of(nothing).empty());
    EXPECT_FALSE(object_in_view(bounds_of(nothing), glm::dmat4(1), view_window(straight)).possible);
}

TEST(ObjectInView, ACornerThatNoTriangleUsesDoesNotCount) {
    TriangleMesh mesh = test::cube_mesh(0.5f);
    mesh.positions.emplace_back(100, 0, 0);
    const ObjectBounds bounds = bounds_of(test::mesh_object("cube", mesh, Rgb(0.5f), false));
    EXPECT_EQ(bounds.greatest, glm::dvec3(0.5));
    EXPECT_NEAR(bounds.radius, std::sqrt(0.75), 1e-6);  // positions are floats
}

/// A cube that turns and moves from one end to the other, grown twofold on the way.
SceneObject travelling_cube() {
    SceneObject cube = test::mesh_object("cube", test::cube_mesh(0.1f), Rgb(0.5f), false);
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 2.0, glm::dvec3(1, 2, 3));
    cube.motion = {{1, glm::translate(glm::dmat4(1), glm::dvec3(-3, 0, 0))},
                   {2, glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(3, 1, 0)) * turned,
                                  glm::dvec3(2, 1, 0.5))}};
    return cube;
}

TEST(ObjectInView, BoundsHoldAMovingObjectAtTheEndsOfItsMotionToo) {
    const VirtualScene scene{{travelling_cube()}};
    const std::vector<ObjectBounds> bounds = bounds_of(scene);
    const TriangleMesh cube = test::cube_mesh(0.1f);
    const Lens narrow = test::telescope(4, 4);
    for (const double time : {-5.0, 1.0, 1.3, 1.999, 2.0, 7.0}) {
        const glm::dmat4 world_from_object = transform_at(scene.objects[0], time);
        for (const glm::vec3& corner : cube.positions) {
            const glm::dvec3 at(world_from_object * glm::dvec4(corner, 1));
            const Pose view = test::look_at(at + glm::dvec3(0, 0.3, 8), at);
            EXPECT_TRUE(gather_facts({scene, bounds, narrow, view, time}).objects[0].in_view);
        }
    }
    const Pose at_start = test::look_at({-3, 0, 8}, {-3, 0, 0});
    EXPECT_TRUE(gather_facts({scene, bounds, narrow, at_start, 0.5}).objects[0].in_view);
    EXPECT_FALSE(gather_facts({scene, bounds, narrow, at_start, 2.5}).objects[0].in_view);
}

}  // namespace
}  // namespace inlay
