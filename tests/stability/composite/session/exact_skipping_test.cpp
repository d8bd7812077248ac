// What is skipped must not show: the same bytes as when everything is computed, on every recording.
#include "composite/session/prepare_scene.h"
#include "composite/session/session.h"
#include "recordings/readers/recording.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// A recording, and where an object stands in its first frame.
struct Place {
    const char* name;
    fs::path folder;
    glm::ivec2 pixel;
};

std::ostream& operator<<(std::ostream& out, const Place& place) { return out << place.name; }

/// A ball of `radius` (m) in even light: most of the image is out of the reach of a small one.
SceneFile ball_at(const Place& place, float radius) {
    const test::TemporaryFolder folder;
    const fs::path file = folder / "scene.json";
    std::ofstream(file) << R"({"version": 1, "environment": {"ambient": [0.8, 0.8, 0.7], "lobes": [
            {"direction": [0.2, 1, 0], "sharpness": 6, "radiance": [2, 2, 2]}]},
        "objects": [{"name": "ball", "sphere": {"radius": )"
                        << radius << R"(}, "place": {"frame": 0, "pixel": [)" << place.pixel.x
                        << ", " << place.pixel.y << R"(]},
        "material": {"type": "diffuse", "reflectance": [0.1, 0.4, 0.4]}}]})";
    return load_scene_file(file);
}

template <class Pixel>
bool same_bytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    return same_size(a, b) &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Pixel)) == 0;
}

struct Skipped {
    std::uint64_t pixels = 0, all = 0;
    std::uint64_t rays = 0;  // against real geometry, that were not traced
};

/// The first two frames, once with and once without skipping.
Skipped compare(const Recording& recording, const SceneFile& scene, Settings settings) {
    const PreparedScene prepared = prepare_scene(scene, recording, settings);
    settings.skip = true;
    Session some = start_session(settings, prepared.scene, prepared.environment);
    settings.skip = false;
    Session all = start_session(settings, prepared.scene, prepared.environment);
    Skipped skipped;
    for (int i = 0; i < 2; ++i) {
        const RgbdFrame frame = recording.load(recording.info.frames[std::size_t(i)]);
        const OutputFrame a = advance(some, frame, FrameWork::compose),
                          b = advance(all, frame, FrameWork::compose);
        EXPECT_TRUE(same_bytes(a.composite.linear, b.composite.linear)) << "frame " << i;
        EXPECT_TRUE(same_bytes(a.composite.display, b.composite.display)) << "frame " << i;
        EXPECT_GT(b.composite.influenced_pixels, 0u) << "the ball is not seen: nothing is compared";
        const auto& sampled = a.noisy->sampled_real.pixels;
        skipped.pixels += std::uint64_t(std::count(sampled.begin(), sampled.end(), 0));
        skipped.all += a.noisy->m.pixels.size();
        skipped.rays += b.rays.real_indirect - a.rays.real_indirect;
        EXPECT_LE(a.rays.real_shadow, b.rays.real_shadow);
    }
    return skipped;
}

class ExactSkipping : public testing::TestWithParam<Place> {
protected:
    void SetUp() override {
        if (fs::is_directory(GetParam().folder)) return;
        ASSERT_STRNE(GetParam().name, "default") << "the project's own recording is missing";
        GTEST_SKIP() << GetParam().folder << " is not here";
    }
};

TEST_P(ExactSkipping, TheChangeSampledForItselfGivesTheSameBytes) {
    const Recording recording = open_recording(GetParam().folder);
    for (const float radius : {0.002f, 0.05f}) {
        const SceneFile scene = ball_at(GetParam(), radius);
        for (const bool temporal : {true, false}) {
            Settings settings;
            settings.trace = with_samples(settings.trace, 1);
            settings.filter.temporal = temporal;
            settings.filter.kernel_radius = 3;  // else a change here and there needs all of E_R
            const Skipped skipped = compare(recording, scene, settings);
            if (radius < 0.01f) {
                EXPECT_GT(skipped.rays, 0u) << "nothing was skipped";
            }
        }
    }
}

TEST_P(ExactSkipping, SharedSamplesGiveTheSameBytes) {
    const Recording recording = open_recording(GetParam().folder);
    Settings settings;
    settings.trace = with_samples(settings.trace, 1);
    settings.trace.estimator = Estimator::two_mode;
    settings.filter.temporal = false;
    settings.filter.kernel_radius = 3;  // else a pixel here and there is enough to need them all
    const Skipped skipped = compare(recording, ball_at(GetParam(), 0.002f), settings);
    EXPECT_GT(skipped.pixels, skipped.all / 4) << "hardly anything was skipped";
    EXPECT_GT(skipped.rays, 0u);
}

/// With the frame before, the second frame reads what the first one did not show.
TEST_P(ExactSkipping, SharedSamplesGiveTheSameBytesWithTheFrameBefore) {
    const Recording recording = open_recording(GetParam().folder);
    Settings settings;
    settings.trace = with_samples(settings.trace, 1);
    settings.trace.estimator = Estimator::two_mode;
    settings.filter.kernel_radius = 3;
    compare(recording, ball_at(GetParam(), 0.002f), settings);
}

const fs::path recordings = fs::path(INLAY_DATA_DIR) / "recordings";

INSTANTIATE_TEST_SUITE_P(
    Recordings, ExactSkipping,
    testing::Values(Place{"default", fs::path(INLAY_SOURCE_DIR) / "apps/demo/recording", {91, 108}},
                    Place{"kitchen", recordings / "kitchen", {325, 207}},
                    Place{"livingroom", recordings / "icl_livingroom", {320, 300}},
                    Place{"rpy", recordings / "tum_fr1_rpy", {320, 300}}),
    [](const auto& place) { return std::string(place.param.name); });

}  // namespace
}  // namespace inlay
