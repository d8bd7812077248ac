// Every built-in recording, frame by frame: the composite, its irradiances and its flicker against
// the scene with the objects really in it, within budgets that are derived before.
#include "composite/accuracy/blame.h"
#include "composite/accuracy/built_in_works.h"
#include "composite/accuracy/frame_verdict.h"
#include "composite/blend/differential.h"
#include "composite/write/atomic_file.h"
#include "composite/write/write_png.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

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
    void explain(const TrackedFrame& frame) const {
        const fs::path place = fs::temp_directory_path() / "inlay_failed" /
                               fmt::format("{}.{}", GetParam(), frame.frame);
        make_folder(place);
        const Image<Rgb> truth = truth_of_frame(work_, frame.frame, frame.lens)->linear;
        const Image<Rgb> picture =
            composite(*frame.photo, light_of(work_, frame, settings_), settings_.blend).linear;
        Image<Rgb> difference = picture;
        for (std::size_t i = 0; i < picture.pixels.size(); ++i)
            difference.pixels[i] = 4.0f * glm::abs(picture.pixels[i] - truth.pixels[i]);
        write_png(place / "composite.png", encode(picture));
        write_png(place / "truth.png", encode(truth));
        write_png(place / "difference_x4.png", encode(difference));
        std::cout << blame_line(blame_frame(work_, frame.frame, settings_, converged_samples))
                  << "\npictures in " << fs::absolute(place).string() << "\n";
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
        const auto verdict = judge_frame(work_, frame, settings_, converged_samples);
        ASSERT_TRUE(verdict.has_value()) << "nothing virtual in frame " << frame.frame;
        std::cout << fmt::format("{} {}: {}\n{} {}\n", work_.name, frame.frame,
                                 budget_line(verdict->budget), work_.name, verdict_line(*verdict));
        for (const BudgetedFigure& figure : figures_of(*verdict))
            EXPECT_LT(figure.value, figure.allowed) << figure.name << " of frame " << frame.frame;
        // An object must be there to be judged, and doing nothing must cost more than is allowed.
        EXPECT_GT(verdict->photograph_rmse, verdict->budget.total);
        // Where the sensor saw nothing there is no irradiance; elsewhere there must be.
        EXPECT_GT(verdict->light.compared, 0.7);
        if (!keeps_budget(*verdict)) explain(frame);
    }
}

INSTANTIATE_TEST_SUITE_P(BuiltIn, PerFrame, testing::ValuesIn(built_in_names()),
                         [](const auto& test) { return test.param; });

}  // namespace
}  // namespace inlay
