// What an object out of view may change of the light: never less than it does, and not everything.
#include "composite/plan/light_reach.h"

#include "composite/plan/effect_plan.h"
#include "composite/plan/explain.h"
#include "recordings/base/random.h"
#include "tests/support/tabletop.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace inlay {
namespace {

using testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();
const Lens lens{64, 48, 60, 60, 31.5, 23.5};

/// A number in 0..1 of its own for each argument.
double number(std::uint32_t i, std::uint32_t which) { return uniform({5, 0, i, 0}, which); }

glm::dvec3 direction(std::uint32_t i, std::uint32_t which) {
    const double turn = 6.2832 * number(i, which), height = 2 * number(i, which + 1) - 1;
    const double flat = std::sqrt(1 - height * height);
    return {flat * std::cos(turn), flat * std::sin(turn), height};
}

double from_to(double low, double high, double at) { return low + (high - low) * at; }

/// A frustum of its own for each `i`; every other one is not about the lens's axis.
SeenSpace space(std::uint32_t i) {
    const glm::dvec2 middle = i % 2 == 0 ? glm::dvec2(0) : glm::dvec2(number(i, 0), -number(i, 1));
    const glm::dvec2 half{from_to(0.05, 1, number(i, 2)), from_to(0.05, 1, number(i, 3))};
    return {{middle - half, middle + half, {60, 60}}, std::pow(10.0, 2 * number(i, 4) - 1)};
}

glm::dvec3 point_in(const SeenSpace& seen, const glm::dvec3& at) {
    const double z = seen.farthest * at.z;
    return {z * glm::mix(seen.window.least, seen.window.greatest, glm::dvec2(at)), z};
}

TEST(LightReach, ABallHidesNoMoreOfTheSkyThanSaidFromAnyPointThatIsSeen) {
    for (std::uint32_t i = 0; i < 2000; ++i) {
        const SeenSpace seen = space(i);
        const double away = std::pow(10.0, 3 * number(i, 5) - 1);
        const Ball ball{away * direction(i, 6), away * std::pow(10.0, -3 * number(i, 8))};
        const double most = hidden_share(ball, seen);
        ASSERT_GT(most, 0);
        ASSERT_LE(most, 1);
        for (std::uint32_t k = 0; k < 100; ++k) {
            const std::uint32_t j = 100 * i + k;
            const glm::dvec3 from = point_in(seen, {number(j, 10), number(j, 11), number(j, 12)});
            const double distance = glm::distance(from, ball.centre);
            // A surface that faces the ball; any other one sees less of it.
            const double hidden = distance > ball.radius ? std::pow(ball.radius / distance, 2) : 1;
            ASSERT_LE(hidden, most * (1 + 1e-12)) << i;
        }
    }
}

TEST(LightReach, TheDistanceIsThatOfTheNearestPoint) {
    for (std::uint32_t i = 0; i < 500; ++i) {
        const SeenSpace seen = space(i);
        const glm::dvec3 point = 3 * seen.farthest * number(i, 5) * direction(i, 6);
        double nearest = infinity;  // over slices, whose nearest points are known
        constexpr int slices = 2000;
        for (int k = 0; k <= slices; ++k) {
            const double z = seen.farthest * k / slices;
            const glm::dvec2 at =
                glm::clamp(glm::dvec2(point), z * seen.window.least, z * seen.window.greatest);
            nearest = std::min(nearest, glm::distance(point, glm::dvec3(at, z)));
        }
        ASSERT_LE(distance_to(seen, point), nearest * (1 + 1e-12)) << i;
        // Half a slice away the nearest point has moved by half of sqrt(1 + 2^2 + 2^2) slices.
        ASSERT_NEAR(distance_to(seen, point), nearest, 1.5 * seen.farthest / slices) << i;
    }
}

TEST(LightReach, HardCasesOfTheDistance) {
    const SeenSpace seen{view_window(lens), 4};
    EXPECT_NEAR(distance_to(seen, {0, 0, -3}), 3, 1e-12);   // behind the camera
    EXPECT_NEAR(distance_to(seen, {0.1, 0, 9}), 5, 1e-12);  // beyond all that is seen
    EXPECT_EQ(distance_to(seen, {0, 0, 0}), 0);
    EXPECT_EQ(distance_to(seen, {0.1, 0.1, 2}), 0);
    EXPECT_NEAR(distance_to({seen.window, 0}, {1, 2, 2}), 3, 1e-12);  // nothing but the camera
    const SeenSpace endless{seen.window};
    EXPECT_NEAR(distance_to(endless, {0, 0, -3}), 3, 1e-12);
    EXPECT_EQ(distance_to(endless, {0, 0, 1e6}), 0);
    EXPECT_GT(distance_to(endless, {5, 0, 1}), 1);
    const glm::dvec2 wide(infinity);
    EXPECT_EQ(distance_to({{-wide, wide, {60, 60}}, 4}, {0, 0, -3}), 0);  // a window without bounds
    EXPECT_EQ(distance_to(seen, glm::dvec3(std::nan(""))), 0);
}

TEST(LightReach, WhatMayTouchWhatIsSeenMayHideEverything) {
    const SeenSpace seen{view_window(lens), 4, 0.01};
    EXPECT_EQ(hidden_share({{0, 0, -1}, 1}, seen), 1);     // touches the camera
    EXPECT_EQ(hidden_share({{0, 0, -1}, 0.99}, seen), 1);  // where rays start
    EXPECT_LT(hidden_share({{0, 0, -1}, 0.98}, seen), 1);
    EXPECT_EQ(hidden_share({{0, 0, -1}, 5}, seen), 1);   // holds the camera
    EXPECT_EQ(hidden_share({{0, 0, 2}, 0.1}, seen), 1);  // in the middle
    EXPECT_EQ(hidden_share({{0, 0, 0}, 0}, seen), 1);
    EXPECT_EQ(hidden_share({{0, 0, -1}, 0}, seen), 0);  // nothing hides nothing
    EXPECT_EQ(light_change({{0, 0, -1}, 0}, seen, infinity), 0);
    EXPECT_EQ(light_change({{0, 0, -1}, 0.1}, seen, infinity), infinity);
}

TEST(LightReach, HalfACodeIsTheLeastChangeThatMovesAByte) {
    for (int code = 0; code <= 255; ++code) {
        const auto byte = std::uint8_t(code);
        const EncodedRgb recorded{byte, byte, byte};
        const Rgb linear = decode(recorded);
        EXPECT_EQ(encode(linear * float(1 + half_code)), recorded) << code;
        EXPECT_EQ(encode(linear * float(1 - half_code)), recorded) << code;
        // Of full white, as much as a surface changes that gets next to no light.
        EXPECT_EQ(encode(linear + float(unseen_change)), recorded) << code;
        EXPECT_EQ(encode(linear - float(unseen_change)), recorded) << code;
    }
    EXPECT_EQ(encode(Rgb(1) * float(1 - 1.01 * half_code)).r, 254);
}

TEST(LightReach, TheRangeOfAnEnvironmentIsOverSolidAnglesAndForEachChannel) {
    const LightRange even = light_range({Image<Rgb>(16, 8, Rgb(0.5f, 2, 0.25f))});
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(even.mean[c], even.brightest[c], 1e-6);
    Image<Rgb> sunny(16, 8, Rgb(0));
    sunny(3, 0) = Rgb(100, 0, 0);
    const LightRange sun = light_range({sunny});
    EXPECT_EQ(sun.brightest, Rgb(100, 0, 0));
    EXPECT_NEAR(sun.mean.r, 100 * (1 - std::cos(std::acos(-1.0) / 8)) / 2 / 16, 1e-6);
    EXPECT_EQ(sun.mean.g, 0);
}

TEST(LightReach, TheContrastIsThatOfTheWorstChannelAndOfWhiteSurfaces) {
    EXPECT_EQ(contrast({Rgb(1), Rgb(1)}, Rgb(1)), 1);
    EXPECT_EQ(contrast({Rgb(0.5f), Rgb(0.5f)}, Rgb(1)), 2);  // a white wall
    EXPECT_EQ(contrast({Rgb(1, 1, 0.5f), Rgb(8, 2, 6)}, Rgb(1)), 12);
    EXPECT_EQ(contrast({Rgb(8), Rgb(8)}, Rgb(1)), 8);      // walls may keep it off
    EXPECT_EQ(contrast({Rgb(1), Rgb(1)}, Rgb(0.25f)), 4);  // white is brighter than it seems
    EXPECT_EQ(contrast({Rgb(1), Rgb(1)}, Rgb(4)), 4);      // dark light is seen
    EXPECT_EQ(contrast({Rgb(0), Rgb(0)}, Rgb(1)), infinity);
    EXPECT_EQ(contrast({Rgb(1, 1, 0), Rgb(1)}, Rgb(1)), infinity);
}

/// Of a ball before a lens at the origin that looks along z and sees real surfaces up to 5 m.
EffectPlan plan_of(const glm::dvec3& centre, const LightRange& light = {Rgb(0.5f), Rgb(2)},
                   int copies = 1, double farthest = 5) {
    VirtualScene scene;
    for (int i = 0; i < copies; ++i)
        scene.objects.push_back(
            test::ball("ball", centre, 0.1f, Phong{Rgb(0.1f), Rgb(0.5f), 32}, false));
    const std::vector<ObjectBounds> bounds = bounds_of(scene);
    const Pose view;
    SceneInFrame in{scene, bounds, lens, view};
    in.lit = true;
    in.light = light;
    in.farthest = farthest;
    return plan_effects(gather_facts(in), {}, {});
}

TEST(LightReach, AFarObjectOutOfViewIsOutWithEveryEffect) {
    const EffectPlan plan = plan_of({0, 0, -87});
    EXPECT_TRUE(plan.names().empty());
    EXPECT_EQ(plan.rays().primary, 0);
    for (const PlannedEffect& e : plan.effects) {
        if (!e.built) continue;
        EXPECT_THAT(e.reason, HasSubstr("1 virtual object out of view changes the light"))
            << e.name;
    }
    EXPECT_THAT(explain(plan), HasSubstr("5.3e-06 of its mean"));  // 4 (0.1 / 87)^2
}

TEST(LightReach, ANearObjectOutOfViewKeepsThePlan) {
    for (const glm::dvec3& near : {glm::dvec3(0, 0, -0.2), glm::dvec3(0, 0, -2),
                                   glm::dvec3(4, 0, 2), glm::dvec3(20, 0, -5)}) {
        const EffectPlan plan = plan_of(near);
        EXPECT_EQ(objects_in_view(plan.facts), 0);
        for (const char* name : {"environment_direct", "environment_indirect", "glossy_at_hits",
                                 "axis_aligned_filter", "temporal_filter"})
            EXPECT_TRUE(plan.has(name)) << name;
        EXPECT_FALSE(plan.has("virtual_surfaces"));
    }
}

TEST(LightReach, AFarObjectInViewStaysIn) {
    EXPECT_TRUE(plan_of({0, 0, 87}).has("virtual_surfaces"));
    EXPECT_TRUE(plan_of({0, 0, 87}).has("environment_indirect"));
}

TEST(LightReach, WhatIsFarAndTooSmallToBeSeenIsOutToo) {
    const EffectPlan plan = plan_of({0, 0, 5000});  // 0.0024 px wide
    EXPECT_TRUE(plan.facts.objects[0].cover.possible);
    EXPECT_TRUE(plan.names().empty());
    EXPECT_FALSE(plan_of({0, 0, 5000}, {Rgb(0.5f), Rgb(2)}, 1, infinity).names().empty());
}

TEST(LightReach, ASunReachesFarther) {
    const LightRange sunny{Rgb(0.5f), Rgb(5e4f)};
    EXPECT_TRUE(plan_of({0, 0, -87}, sunny).has("environment_direct"));
    EXPECT_TRUE(plan_of({0, 0, -5000}, sunny).names().empty());
}

TEST(LightReach, ManyFarObjectsCountTogether) {
    const LightRange light{Rgb(0.5f), Rgb(2)};
    EXPECT_TRUE(plan_of({0, 0, -87}, light, 16).names().empty());
    EXPECT_FALSE(plan_of({0, 0, -87}, light, 18).names().empty());
}

TEST(LightReach, WithoutLightToCompareWithNothingIsProven) {
    EXPECT_FALSE(plan_of({0, 0, -87}, {}).names().empty());
    EXPECT_FALSE(plan_of({0, 0, -87}, {Rgb(0.5f, 0.5f, 0), Rgb(2)}).names().empty());
}

}  // namespace
}  // namespace inlay
