// The plan: facts decide, in words, and the view of each frame counts.
#include "composite/plan/effect_plan.h"

#include "composite/plan/effect_rules.h"
#include "composite/plan/explain.h"
#include "tests/support/tabletop.h"
#include "tests/support/test_scenes.h"

#include <gmock/gmock.h>

#include <set>

namespace inlay {
namespace {

using testing::HasSubstr;
using testing::Not;

const Lens lens{64, 48, 60, 60, 31.5, 23.5};

SceneFacts facts_of(const VirtualScene& scene, const Pose& view = test::camera_around(0)) {
    return gather_facts({scene, bounds_of(scene), lens, view, 0, 0, true});
}

EffectPlan plan_of(const SceneFacts& facts) { return plan_effects(facts, {}, {}); }

EffectPlan plan_of(const VirtualScene& scene, const Pose& view = test::camera_around(0)) {
    return plan_of(facts_of(scene, view));
}

VirtualScene one(const Material& material, const glm::dvec3& centre = {0, 0.05, 0},
                 float radius = 0.05f) {
    return {{test::ball("ball", centre, radius, material, false)}};
}

const PlannedEffect& effect(const EffectPlan& plan, const std::string& name) {
    for (const PlannedEffect& e : plan.effects)
        if (e.name == name) return e;
    throw std::out_of_range(name);
}

const Material glossy = Phong{Rgb(0.1f), Rgb(0.5f), 32};

TEST(EffectPlan, EveryEffectHasANameAReasonAndAWorth) {
    std::set<std::string> names;
    for (const VirtualScene& scene : {VirtualScene{}, one(Diffuse{}), one(glossy)}) {
        for (const PlannedEffect& e : plan_of(scene).effects) {
            names.insert(e.name);
            EXPECT_FALSE(e.reason.empty()) << e.name;
            EXPECT_FALSE(e.worth.empty()) << e.name;
            EXPECT_TRUE(e.in || e.cost.passes.empty()) << e.name;
            EXPECT_TRUE(e.built || !e.in) << e.name;
        }
    }
    EXPECT_EQ(names.size(), effect_rules().size());  // no name twice
}

TEST(EffectPlan, NothingIsPlannedWithoutObjectsOrAPose) {
    EXPECT_TRUE(plan_of(VirtualScene{}).names().empty());
    EXPECT_TRUE(plan_of(test::tabletop()).names().empty());  // real ones do not count
    SceneFacts lost = facts_of(one(glossy));
    lost.tracked = false;
    EXPECT_TRUE(plan_of(lost).names().empty());
    EXPECT_EQ(plan_of(lost).rays().primary, 0);
}

TEST(EffectPlan, GlossyIsWhatReflectsBesideItsLambertianPart) {
    EXPECT_FALSE(is_glossy(Diffuse{}));
    EXPECT_FALSE(is_glossy(Phong{Rgb(0.5f), Rgb(0), 64}));
    EXPECT_TRUE(is_glossy(glossy));
    EXPECT_TRUE(is_glossy(Ggx{}));
    EXPECT_FALSE(plan_of(one(Diffuse{})).has("glossy"));
    EXPECT_FALSE(plan_of(one(Diffuse{})).has("glossy_at_hits"));
    EXPECT_TRUE(plan_of(one(glossy)).has("glossy"));
    EXPECT_TRUE(plan_of(one(glossy)).has("glossy_at_hits"));
}

TEST(EffectPlan, AnObjectOutOfViewLosesWhatIsSeenAndKeepsItsShadow) {
    const EffectPlan behind = plan_of(one(glossy, {0, 0.7, 2}));
    EXPECT_FALSE(behind.has("virtual_surfaces"));
    EXPECT_FALSE(behind.has("glossy"));
    EXPECT_TRUE(behind.has("glossy_at_hits"));
    EXPECT_TRUE(behind.has("environment_direct"));
    EXPECT_TRUE(behind.has("environment_indirect"));
    EXPECT_THAT(effect(behind, "environment_indirect").reason, HasSubstr("not proven"));
    EXPECT_LT(behind.rays().primary, plan_of(one(glossy)).rays().primary);
}

TEST(EffectPlan, TheGlossyOneOfTwoMayBeOutOfView) {
    VirtualScene scene = one(Diffuse{});
    scene.objects.push_back(test::ball("chrome", {0, 0.7, 2}, 0.05f, glossy, false));
    const EffectPlan plan = plan_of(scene);
    EXPECT_TRUE(plan.has("virtual_surfaces"));
    EXPECT_FALSE(plan.has("glossy"));
}

TEST(EffectPlan, AnObjectFarBelowAPixelIsNotSeenButASinglePixelIs) {
    const double distance = glm::length(glm::dvec3(0, 0.55, 0.9));
    const auto of_size = [&](double px) {
        return plan_of(one(Diffuse{}, {0, 0.05, 0}, float(0.5 * px / 60 * distance)));
    };
    EXPECT_TRUE(of_size(1).has("virtual_surfaces"));
    EXPECT_TRUE(of_size(0.1).has("virtual_surfaces"));
    EXPECT_FALSE(of_size(0.01).has("virtual_surfaces"));
    EXPECT_TRUE(of_size(0.01).has("environment_direct"));
}

TEST(EffectPlan, AnObjectThatFillsTheViewCostsEveryPixelAtMost) {
    const EffectPlan plan = plan_of(one(glossy, {0, 0.6, 0.9}, 3));
    for (const PlannedEffect& e : plan.effects)
        for (const PlannedPass& pass : e.cost.passes)
            EXPECT_EQ(pass.share_of_pixels, 1) << pass.name;
}

TEST(EffectPlan, FollowsEveryFrameOfAnObjectThatComesAndGoes) {
    VirtualScene scene = one(glossy);
    scene.objects[0].motion.clear();
    for (int frame = 0; frame < 6; ++frame) {
        const glm::dvec3 at = frame % 2 == 0 ? glm::dvec3(0, 0.05, 0) : glm::dvec3(0, 0.7, 2);
        scene.objects[0].motion.push_back({double(frame), glm::translate(glm::dmat4(1), at)});
    }
    const std::vector<ObjectBounds> bounds = bounds_of(scene);
    for (int frame = 0; frame < 6; ++frame) {
        const EffectPlan plan = plan_of(gather_facts(
            {scene, bounds, lens, test::camera_around(0), double(frame), frame - 1.0, true}));
        EXPECT_EQ(plan.has("virtual_surfaces"), frame % 2 == 0) << frame;
        EXPECT_EQ(plan.has("glossy"), frame % 2 == 0) << frame;
        EXPECT_EQ(plan.facts.moving, frame > 0) << frame;
        EXPECT_EQ(plan.has("temporal_filter"), frame == 0) << frame;
    }
}

TEST(EffectPlan, SettingsAndFramesDecideTheFilters) {
    const SceneFacts facts = facts_of(one(Diffuse{}));
    FilterSettings off;
    off.enabled = false;
    EXPECT_FALSE(plan_effects(facts, {}, off).has("axis_aligned_filter"));
    EXPECT_FALSE(plan_effects(facts, {}, off).has("temporal_filter"));
    FilterSettings still;
    still.temporal = false;
    EXPECT_TRUE(plan_effects(facts, {}, still).has("axis_aligned_filter"));
    EXPECT_FALSE(plan_effects(facts, {}, still).has("temporal_filter"));
    SceneFacts first = facts;
    first.first_frame = true;
    EXPECT_FALSE(plan_of(first).has("temporal_filter"));
    EXPECT_TRUE(plan_of(facts).has("temporal_filter"));
}

struct Asked {
    const char* name;
    SceneRequests requests;
};

TEST(EffectPlan, WhatIsNotBuiltIsListedAndNeverIn) {
    const std::vector<Asked> table{{"polygon_light", {.polygon_lights = 2}},
                                   {"mesh_light", {.mesh_lights = 1}},
                                   {"medium", {.medium = true}},
                                   {"defocus", {.aperture_radius = 0.01, .focus_distance = 1}},
                                   {"motion_blur", {.shutter = 0.02}}};
    for (const Asked& asked : table) {
        SceneFacts facts = facts_of(one(Diffuse{}));
        const EffectPlan before = plan_of(facts);
        EXPECT_FALSE(effect(before, asked.name).asked);
        facts.requests = asked.requests;
        const EffectPlan plan = plan_of(facts);
        for (const PlannedEffect& e : plan.effects)
            EXPECT_EQ(e.asked, e.name == asked.name) << e.name;
        EXPECT_FALSE(plan.has(asked.name));
        EXPECT_EQ(plan.names(), before.names());
        EXPECT_THAT(explain(plan), HasSubstr(std::string("out  ") + asked.name +
                                             ": not built, so that the scene is refused: "));
    }
}

TEST(EffectPlan, ExplainsEveryEffectAndEveryPass) {
    const EffectPlan plan = plan_of(one(glossy));
    const std::string text = explain(plan);
    for (const PlannedEffect& e : plan.effects)
        EXPECT_THAT(text, HasSubstr((e.in ? "in   " : "out  ") + e.name + ": "));
    for (const char* pass : {"direct light: 16", "camera rays: 4", "coverage rays: 28",
                             "glossy lobes: 128", "smoothing of layers: 7"})
        EXPECT_THAT(text, HasSubstr(std::string("pass ") + pass));
    EXPECT_THAT(text, HasSubstr("object ball: glossy, may be in view, up to "));
    EXPECT_THAT(explain(plan_of(VirtualScene{})), Not(HasSubstr("pass ")));
}

TEST(EffectPlan, SaysWhereLightIsKept) {
    SceneFacts facts = plan_of(one(glossy)).facts;
    EXPECT_THAT(explain(plan_of(facts)), Not(HasSubstr("kept on the model")));
    facts.light_kept = true;
    EXPECT_THAT(explain(plan_of(facts)), HasSubstr("kept on the model"));
    SceneFacts nothing = plan_of(VirtualScene{}).facts;
    nothing.light_kept = true;  // and nothing to read it
    EXPECT_THAT(explain(plan_of(nothing)), Not(HasSubstr("kept on the model")));
}

}  // namespace
}  // namespace inlay
