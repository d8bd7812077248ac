// A recording is tracked once: its poses are kept, and the model comes back the same.
#include "composite/session/known_recording.h"

#include "composite/session/reconstruction_json.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;

class KnownRecording : public ::testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder / "recording");
        std::ofstream(folder / "recording" / "frames") << "some";
        ::setenv("XDG_CACHE_HOME", (folder / "cache").c_str(), 1);
    }
    void TearDown() override {
        ::unsetenv("XDG_CACHE_HOME");
        fs::remove_all(folder);
    }

    Recording recording() {
        Recording r;
        r.info.path = folder / "recording";
        r.info.lens = test::small_lens();
        for (int i = 0; i < 6; ++i) {
            r.info.frames.push_back(i + 3);
            r.info.times.push_back(i / 30.0);
            r.info.world_from_camera.emplace_back();
        }
        r.load = [this](int number) {
            ++loads;
            return test::room_frame(number, test::posed({0, 0.01 * number, 0}, {}), 1);
        };
        return r;
    }

    fs::path kept_file() const {
        for (const auto& entry : fs::directory_iterator(folder / "cache" / "inlay"))
            return entry.path();
        return {};
    }

    fs::path folder = fs::temp_directory_path() / ("inlay_known_" + std::to_string(::getpid()));
    std::atomic<int> loads = 0;
};

/// Three passes over six frames, after five were read to check the scale of their depth.
constexpr int tracked_loads = 3 * 6 + 5;

bool same(const Reconstruction& a, const Reconstruction& b) {
    if (to_json(a) != to_json(b) || a.volume.bricks.size() != b.volume.bricks.size()) return false;
    for (std::size_t i = 0; i < a.volume.bricks.size(); ++i) {
        const Brick &p = a.volume.bricks[i], &q = b.volume.bricks[i];
        if (p.key != q.key || p.distance != q.distance || p.weight != q.weight ||
            p.color != q.color)
            return false;
    }
    return true;
}

TEST_F(KnownRecording, IsTrackedOnceAndFusedToTheSameBytes) {
    const auto first = know_recording(recording(), {});
    EXPECT_EQ(loads.exchange(0), tracked_loads);
    const auto second = know_recording(recording(), {});
    EXPECT_EQ(loads, 6);  // for the model alone
    EXPECT_TRUE(same(*first, *second));
    EXPECT_EQ(position_of(*second, 5), 2);
    EXPECT_EQ(position_of(*second, 99), -1);
}

TEST_F(KnownRecording, IsTrackedAgainForOtherSettingsAndOtherFiles) {
    know_recording(recording(), {});
    Settings finer;
    finer.slam.fusion.voxel_size = 0.007f;
    loads = 0;
    know_recording(recording(), finer);
    EXPECT_EQ(loads.exchange(0), tracked_loads);
    std::ofstream(folder / "recording" / "frames") << "others";
    know_recording(recording(), {});
    EXPECT_EQ(loads, tracked_loads);
}

TEST_F(KnownRecording, ADamagedCacheCostsTimeAlone) {
    const auto first = know_recording(recording(), {});
    for (const char* text : {"", "{", "{\"key\":3}", "[]"}) {
        std::ofstream(kept_file(), std::ios::trunc) << text;
        loads = 0;
        const auto again = know_recording(recording(), {});
        EXPECT_EQ(loads, tracked_loads) << text;
        EXPECT_TRUE(same(*first, *again)) << text;
    }
}

TEST_F(KnownRecording, WithoutALookAheadNothingIsKnown) {
    Settings fast;
    fast.slam = fast_slam();
    EXPECT_EQ(know_recording(recording(), fast), nullptr);
    EXPECT_EQ(loads, 0);
}

TEST_F(KnownRecording, AStoppedOneIsNotKept) {
    const auto stopped = know_recording(recording(), {}, [](int frames) { return frames < 3; });
    EXPECT_FALSE(stopped->complete);
    EXPECT_FALSE(fs::exists(folder / "cache" / "inlay"));
}

TEST(ReconstructionJson, KeyframesNameTheirFrames) {
    Reconstruction r;
    for (int i = 0; i < 4; ++i)
        r.frames.push_back({10 + i, i / 30.0, {}, {}});
    r.keyframes = {0, 3};
    r.loops.push_back({0, 1, {}, {}});
    const auto json = keyframes_json(r);
    EXPECT_EQ(json["keyframes"][1]["frame"], 13);
    EXPECT_EQ(json["loops"][0]["to_frame"], 13);
    r.frames[2].tracking.why = "it is dark";
    EXPECT_EQ(status_json(r.frames[2])["why"], "it is dark");
}

}  // namespace
}  // namespace inlay
