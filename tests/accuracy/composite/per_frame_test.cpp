// Every built-in recording, frame by frame: the composite against the scene with the objects really
// in it, within a budget that is derived before the composite is made.
#include "composite/accuracy/blame.h"
#include "composite/accuracy/built_in_works.h"
#include "composite/accuracy/frame_budget.h"
#include "composite/accuracy/judged_frames.h"
#include "composite/blend/differential.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <iostream>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// Enough that the truth's own noise, which is taken out, is well below what is measured.
const BuiltInSettings small{{160, 120}, 8, 48, 192, {3, 7}};
constexpr int converged_samples = 256;

class PerFrame : public testing::TestWithParam<std::string> {
protected:
    PerFrame()
        : folder_(fs::temp_directory_path() /
                  fmt::format("inlay_per_frame_{}_{}", GetParam(), getpid())),
          work_(built_in_work(GetParam(), fs::path(INLAY_SOURCE_DIR) / "apps" / "scenes", folder_,
                              small)) {}
    ~PerFrame() override { fs::remove_all(folder_); }

    /// What a failing frame leaves beside the test: pictures, and which stage is to blame.
    void explain(int frame, const Image<Rgb>& picture, const Image<Rgb>& truth) const {
        const fs::path place =
            fs::temp_directory_path() / "inlay_failed" / fmt::format("{}.{}", GetParam(), frame);
        make_folder(place);
        Image<Rgb> difference = picture;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            difference.pixels[i] = 4.0f * glm::abs(picture.pixels[i] - truth.pixels[i]);
        write_png(place / "composite.png", encode(picture));
        write_png(place / "truth.png", encode(truth));
        write_png(place / "difference_x4.png", encode(difference));
        std::cout << blame_line(blame_frame(work_, frame, settings_, converged_samples))
                  << "\npictures in " << fs::absolute(place).string() << "\n";
    }

    void judge_composite(const TrackedFrame& frame, const FrameBudget& budget,
                         const Layers& layers) const {
        const Reference truth = *truth_of_frame(work_, frame.frame, frame.lens);
        const Composite picture = composite(*frame.photo, layers, settings_.blend);
        const double rmse =
            std::sqrt(error_against(truth, picture.linear, picture.display).mean_square_influenced);
        std::cout << fmt::format("{} {}: RMSE {:.4f} over influenced pixels\n", work_.name,
                                 frame.frame, rmse);
        EXPECT_LT(rmse, budget.total);
        // An object must be there to be judged, and doing nothing must cost more than is allowed.
        const double nothing = std::sqrt(
            error_against(truth, frame.photo->linear, frame.photo->encoded).mean_square_influenced);
        EXPECT_GT(nothing, budget.total);
        if (rmse >= budget.total) explain(frame.frame, picture.linear, truth.linear);
    }

    void judge_irradiance(const TrackedFrame& frame, const FrameBudget& budget,
                          const Layers& layers) const {
        const TrackedFrame exact = with_true_room(work_, frame, true_pose(work_, frame.frame));
        const Layers wanted = light_of(work_, exact, settings_, converged_samples);
        const IrradianceError error = irradiance_error(layers, wanted);
        // What reconstruction costs, without noise: rooms that no frame has seen shade nothing.
        const IrradianceError geometry =
            irradiance_error(light_of(work_, frame, settings_, converged_samples), wanted);
        std::cout << fmt::format(
            "{} {}: relative RMSE of E_R {:.3f}, of E_RV {:.3f}; geometry alone {:.3f}, {:.3f}\n",
            work_.name, frame.frame, error.e_r, error.e_rv, geometry.e_r, geometry.e_rv);
        // Where the sensor saw nothing there is no irradiance; elsewhere there must be.
        EXPECT_GT(error.compared, 0.7);
        // The two causes add as squares; a tenth more for what they share.
        EXPECT_LT(error.e_r, 1.1 * std::hypot(geometry.e_r, budget.e_r));
        EXPECT_LT(error.e_rv, 1.1 * std::hypot(geometry.e_rv, budget.e_rv));
    }

    /// Of a still camera, in pixels that objects influence.
    void judge_flicker(int frame) const {
        const auto frames = judge_frames(work_, {frame}, Sampling{settings_}, converged_samples);
        UnitPlan plan{"samples", "16", settings_, {}, true, true};
        plan.cells = {{&method_named("unfiltered"), false, 0},
                      {&method_named("axis_aligned"), false, 0}};
        const UnitRun run = measure_unit(work_, frames, plan);
        ASSERT_EQ(run.runs.size(), 2u);
        for (const MethodRun& method : run.runs)
            ASSERT_TRUE(method.flicker.has_value()) << method.method << " " << method.failed;
        std::cout << fmt::format("{}: flicker {:.4f} unfiltered, {:.4f} filtered\n", work_.name,
                                 *run.runs[0].flicker, *run.runs[1].flicker);
        EXPECT_LT(*run.runs[1].flicker, *run.runs[0].flicker);
    }

    fs::path folder_;
    Settings settings_;
    Work work_;
};

TEST_P(PerFrame, PictureIrradiancesAndFlickerKeepTheirBudgets) {
    const auto frames = track_frames(work_, work_.truth_frames, settings_);
    ASSERT_EQ(frames.size(), 2u);
    for (const TrackedFrame& frame : frames) {
        ASSERT_NE(frame.tracking.status, TrackingStatus::lost) << "frame " << frame.frame;
        const FrameBudget budget = frame_budget(work_, frame, settings_, converged_samples);
        std::cout << fmt::format("{} {}: {}\n", work_.name, frame.frame, budget_line(budget));
        const Layers layers = light_of(work_, frame, settings_);
        judge_composite(frame, budget, layers);
        judge_irradiance(frame, budget, layers);
    }
    judge_flicker(frames.back().frame);
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, PerFrame, testing::ValuesIn(built_in_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace inlay
