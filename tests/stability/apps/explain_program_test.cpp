// The plan of six scenes, printed, and the refusal of those that ask for what is not built.
#include "tests/support/program_runs.h"

namespace inlay {
namespace {

using test::Outcome;
using test::run_program;
using test::TemporaryFolder;
using testing::HasSubstr;
using testing::Not;

struct PlannedScene {
    const char* file;
    std::vector<const char*> in;       // effects that the scene takes
    std::vector<const char*> refused;  // effects that it asks for in vain
};

const std::vector<PlannedScene> six_scenes{
    {"empty", {}, {}},
    {"diffuse", {"environment_direct", "environment_indirect", "virtual_surfaces"}, {}},
    {"glossy_and_diffuse", {"virtual_surfaces", "glossy", "glossy_at_hits"}, {}},
    {"polygon_light", {"environment_direct", "virtual_surfaces"}, {"polygon_light"}},
    {"medium", {"environment_direct", "virtual_surfaces"}, {"medium"}},
    {"shutter_and_aperture",
     {"environment_direct", "virtual_surfaces"},
     {"defocus", "motion_blur"}}};

std::string path_of(const PlannedScene& scene) {
    return std::string(INLAY_SOURCE_DIR "/tests/support/plan_scenes/") + scene.file + ".json";
}

TEST(Explain, PrintsThePlanOfSixScenesAndWritesNothing) {
    for (const PlannedScene& scene : six_scenes) {
        const TemporaryFolder folder;
        const Outcome outcome = run_program("render " + path_of(scene) + " --explain --out " +
                                            (folder / "x.exr").string());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        for (const char* effect : scene.in)
            EXPECT_THAT(outcome.out, HasSubstr(std::string("in   ") + effect + ": "));
        for (const char* effect : scene.refused)
            EXPECT_THAT(outcome.out, HasSubstr(std::string("out  ") + effect +
                                               ": not built, so that the scene is refused: "));
        if (scene.in.empty()) {
            EXPECT_THAT(outcome.out, Not(HasSubstr("in   ")));
        }
        if (scene.refused.empty()) {
            EXPECT_THAT(outcome.out, Not(HasSubstr("is refused")));
        }
        EXPECT_EQ(folder.entries(), 0);
    }
}

TEST(Explain, TheCostFollowsTheSettings) {
    const std::string command =
        "render " + path_of(six_scenes[1]) + " --explain --samples 8 --filter off";
    const Outcome few = run_program(command);
    EXPECT_THAT(few.out, HasSubstr("pass real direct light: 8 per pixel"));
    EXPECT_THAT(few.out, HasSubstr("pass directions tried for a change: 36 per pixel"));
    EXPECT_THAT(run_program(command + " --set render.estimator=two_mode").out,
                HasSubstr("pass direct light: 8 per pixel"));
    EXPECT_THAT(few.out, HasSubstr("out  axis_aligned_filter: filter.enabled is off"));
}

TEST(Explain, WhatIsNotBuiltIsRefusedByName) {
    for (const PlannedScene& scene : six_scenes) {
        if (scene.refused.empty()) continue;
        const TemporaryFolder folder;
        const std::string out = (folder / "x.exr").string();
        for (const std::string& command : {"render " + path_of(scene) + " --out " + out,
                                           "replay " + test::tiny_recording().string() +
                                               " --scene " + path_of(scene) + " --out " + out,
                                           "record " + path_of(scene) + " --out " + out}) {
            const Outcome outcome = run_program(command);
            EXPECT_EQ(outcome.code, 65) << command;
            for (const char* effect : scene.refused)
                EXPECT_THAT(outcome.err, HasSubstr(effect));
            EXPECT_THAT(outcome.err, HasSubstr("cannot be done by this version"));
        }
        EXPECT_EQ(folder.entries(), 0);
    }
}

}  // namespace
}  // namespace inlay
