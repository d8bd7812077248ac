// The default recording replayed against its truth: the same scene, path-traced with the objects
// really in it.
#include "composite/measure/image_error.h"
#include "composite/session/known_recording.h"
#include "composite/session/prepare_scene.h"
#include "composite/session/session.h"
#include "recordings/base/check.h"
#include "recordings/environment/exr_image.h"
#include "recordings/readers/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iostream>

namespace inlay {
namespace {

namespace fs = std::filesystem;

const fs::path folder = fs::path(INLAY_SOURCE_DIR) / "apps" / "demo" / "recording";

struct FrameError {
    int frame = 0;
    double composite = 0, photograph = 0;  // RMSE of linear radiance over pixels the objects change
    double noise = 0;                      // the truth's own standard error there
    double psnr = 0;                       // dB, display picture, all pixels
};

/// Pixels that the objects change: where the two truths differ by more than their noise.
Mask changed_pixels(const Image<Rgb>& with, const Image<Rgb>& without, const Image<Rgb>& error) {
    require(same_size(with, without) && same_size(with, error), "truths differ in size");
    Mask changed(with.width, with.height);
    for (std::size_t i = 0; i < with.pixels.size(); ++i)
        changed.pixels[i] = luminance(glm::abs(with.pixels[i] - without.pixels[i])) >
                            6 * luminance(error.pixels[i]) + 0.004f;
    return changed;
}

FrameError error_of(const OutputFrame& out, int frame) {
    const auto read = [&](const char* kind, const char* end) {
        return read_exr(folder / "truth" / kind / fmt::format("{:06d}{}.exr", frame, end));
    };
    const Image<Rgb> truth = read("composite", ""), noise = read("composite", ".stderr");
    const Image<Rgb> none(noise.width, noise.height, Rgb(0));
    const Mask changed = changed_pixels(truth, read("recorded", ""), noise);
    return {frame, radiance_error(out.composite.linear, truth, changed).rmse,
            radiance_error(out.camera, truth, changed).rmse,
            radiance_error(noise, none, changed).rmse, psnr(out.composite.display, encode(truth))};
}

std::vector<FrameError> replay(bool true_poses) {
    const Recording recording = open_recording(folder);
    Settings settings;
    settings.use_recorded_poses = true_poses;
    const auto known = reconstruct_afresh(recording, settings);
    PreparedScene prepared =
        prepare_scene(load_scene_file(folder / "scene.json"), recording, settings, known.get());
    Session session =
        start_session(settings, std::move(prepared.scene), std::move(prepared.environment), known);
    std::vector<FrameError> errors;
    for (const int number : recording.info.frames) {
        const bool has_truth =
            fs::exists(folder / "truth" / "composite" / fmt::format("{:06d}.exr", number));
        const OutputFrame out = advance(session, recording.load(number),
                                        has_truth ? FrameWork::compose : FrameWork::sample);
        EXPECT_EQ(out.tracking.status, TrackingStatus::tracked) << "frame " << number;
        if (has_truth) errors.push_back(error_of(out, number));
    }
    return errors;
}

class DefaultRecording : public testing::TestWithParam<bool> {};

TEST_P(DefaultRecording, CompositeIsCloseToTheSceneWithTheObjectsReallyInIt) {
    const std::vector<FrameError> errors = replay(GetParam());
    ASSERT_EQ(errors.size(), 4u);
    for (const FrameError& e : errors) {
        std::cout << fmt::format(
            "{} poses, frame {:2}: RMSE {:.4f} over changed pixels (photograph "
            "alone {:.4f}, truth's noise {:.4f}), PSNR {:.1f} dB\n",
            GetParam() ? "true" : "tracked", e.frame, e.composite, e.photograph, e.noise, e.psnr);
        // An object that floats, misses its shadow or has the wrong light loses this factor: what
        // is left is silhouettes (a pixel's width of error all around), sensor noise in the real
        // geometry, and bounces beyond the first.
        const double allowed = e.photograph / 8;
        // Truth must be clean enough to judge: its noise, which is taken out of the mean square,
        // makes up less than a quarter of it, and less than a ninth of what is allowed.
        EXPECT_LT(e.noise, e.composite / 2);
        EXPECT_LT(e.noise, allowed / 3);
        EXPECT_LT(std::sqrt(e.composite * e.composite - e.noise * e.noise), allowed);
    }
}

INSTANTIATE_TEST_SUITE_P(Poses, DefaultRecording, testing::Bool());

}  // namespace
}  // namespace inlay
