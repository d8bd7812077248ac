// A recording gone over again: loops close, lost frames are found, early frames know what later
// ones saw.
#include "slam/mapping/advance_slam.h"
#include "slam/mapping/reconstruct_recording.h"
#include "slam/mapping/trajectory_error.h"
#include "tests/unit/slam/four_walls.h"

#include <gtest/gtest.h>

#include <vector>

namespace inlay {
namespace {

const GoOn to_the_end = [](int) { return true; };

std::vector<Pose> poses_of(const Reconstruction& result) {
    std::vector<Pose> poses;
    for (const ReconstructedFrame& frame : result.frames)
        poses.push_back(frame.tracking.world_from_camera);
    return poses;
}

/// Once around the room, and a little more.
constexpr int around = 300, frames = 320;

std::vector<Pose> true_path() {
    std::vector<Pose> poses;
    for (int i = 0; i < frames; ++i)
        poses.push_back(test::around_the_room(double(i) / around));
    return poses;
}

FrameSource walk(double bend) {
    return test::frames_from(frames, [bend](int i) {
        const Pose pose = test::around_the_room(double(i) / around);
        RgbdFrame frame = test::wall_frame(i, pose, 1, bend);
        if (i == 0) frame.recorded_world_from_camera = pose;
        return frame;
    });
}

/// How far (m) the motion from the first view to the one a turn later is from the true one.
double gap(const std::vector<Pose>& poses) {
    const auto motion = [](const std::vector<Pose>& p) {
        return inverse(p.front()) * p[std::size_t(around)];
    };
    return glm::length((inverse(motion(true_path())) * motion(poses)).translation);
}

TEST(ReconstructRecording, ALoopAlongFourWallsCloses) {
    // Depth that is 0.1 % too large at the sides bends every wall, so that a chain of motions
    // turns too far.
    SlamSettings once = accurate_slam();
    once.look_ahead = false;
    const auto source = walk(0.001);
    const Reconstruction chain =
        reconstruct_recording(source, first_pass_of(once), PoseSource::tracked, to_the_end);
    const Reconstruction result =
        reconstruct_recording(source, accurate_slam(), PoseSource::tracked, to_the_end);
    const double before = gap(poses_of(chain)), after = gap(poses_of(result));
    RecordProperty("gap_before_mm", int(1000 * before));
    RecordProperty("gap_after_mm", int(1000 * after));
    RecordProperty("ate_before_mm", int(1000 * absolute_error(poses_of(chain), true_path()).rms));
    RecordProperty("ate_after_mm", int(1000 * absolute_error(poses_of(result), true_path()).rms));
    EXPECT_GT(before, 0.03);  // else there is nothing to close
    EXPECT_FALSE(result.loops.empty());
    EXPECT_LT(after, before / 3);
    EXPECT_LT(absolute_error(poses_of(result), true_path()).rms,
              absolute_error(poses_of(chain), true_path()).rms);
}

/// Depth that is 0.5 % too large at the sides: the drift of a turn is farther than ICP reaches, and
/// only what is painted on the walls tells that the camera is back.
TEST(ReconstructRecording, ALoopBeyondReachOfIcpClosesByLandmarks) {
    constexpr int turn = 200, count = 212;
    const auto pose_at = [](int i) { return test::around_the_room(double(i) / turn); };
    const auto walk_with = [&](const Lens& lens, bool painted) {
        return test::frames_from(count, [=](int i) {
            RgbdFrame frame = test::wall_frame(i, pose_at(i), 1, 0.005, lens, painted);
            if (i == 0) frame.recorded_world_from_camera = pose_at(0);
            return frame;
        });
    };
    std::vector<Pose> truth;
    for (int i = 0; i < count; ++i)
        truth.push_back(pose_at(i));
    SlamSettings once = first_pass_of(accurate_slam());
    const FrameSource painted = walk_with(scaled(test::small_lens(), 320, 240), true);
    const Reconstruction chain =
        reconstruct_recording(painted, once, PoseSource::tracked, to_the_end);
    const Reconstruction result =
        reconstruct_recording(painted, accurate_slam(), PoseSource::tracked, to_the_end);
    const Reconstruction unpainted = reconstruct_recording(
        walk_with(test::small_lens(), false), accurate_slam(), PoseSource::tracked, to_the_end);
    const double before = absolute_error(poses_of(chain), truth).rms;
    const double after = absolute_error(poses_of(result), truth).rms;
    RecordProperty("ate_before_mm", int(1000 * before));
    RecordProperty("ate_after_mm", int(1000 * after));
    EXPECT_GT(before, 0.15);
    EXPECT_TRUE(unpainted.loops.empty());  // ICP alone finds none
    EXPECT_FALSE(result.loops.empty());
    EXPECT_LT(after, before / 3);
}

/// From frame 20 on the camera lets in half as much light again: said of every frame, whether the
/// model is finished or grows, and whether poses are tracked or recorded.
TEST(ReconstructRecording, AChangeOfExposureIsFollowed) {
    constexpr int shown = 40, change = 20;
    const Lens lens = scaled(test::small_lens(), 320, 240);
    const FrameSource source = test::frames_from(shown, [&](int i) {
        const Pose pose = test::around_the_room(i / 300.0);
        RgbdFrame frame = test::wall_frame(i, pose, 1, 0, lens, true);
        frame.recorded_world_from_camera = pose;
        for (EncodedRgb& pixel : frame.color.pixels)
            pixel = encode((i < change ? 0.5f : 0.75f) * decode(pixel));
        return frame;
    });
    SlamSettings grows = accurate_slam();
    grows.look_ahead = false;
    for (const auto& [settings, poses] : {std::pair{accurate_slam(), PoseSource::tracked},
                                          {accurate_slam(), PoseSource::recorded},
                                          {grows, PoseSource::tracked}}) {
        const Reconstruction result = reconstruct_recording(source, settings, poses, to_the_end);
        for (int i = 0; i < shown; ++i) {
            const Rgb gain = result.frames[std::size_t(i)].gain;
            for (int c = 0; c < 3; ++c) {
                // Noise of bytes averages out; voxels mix what is painted beside each other.
                if (i < change)
                    EXPECT_EQ(gain[c], 1) << i;
                else
                    EXPECT_NEAR(gain[c], 1.5f, 0.03f) << i;
            }
        }
    }
}

/// The camera comes back upside down to where it started, which no turned start is near to.
TEST(FindWayBack, LandmarksFindACameraThatIsTurnedRound) {
    const Lens lens = scaled(test::small_lens(), 320, 240);
    const SlamSettings settings = first_pass_of(accurate_slam());
    SlamState state = start_slam(settings);
    const auto show = [&](int i, const Pose& pose) {
        RgbdFrame frame = test::wall_frame(i, pose, 1, 0, lens, true);
        if (i == 0) frame.recorded_world_from_camera = pose;
        return track_and_fuse(state, frame, settings, std::nullopt);
    };
    for (int i = 0; i < 40; ++i)
        ASSERT_EQ(show(i, test::around_the_room(i / 300.0)).status, TrackingStatus::tracked) << i;
    const Pose turned = test::around_the_room(0) * test::posed({0, 0, 2.5}, {0.05, 0, 0});
    const TrackResult found = show(40, turned);
    ASSERT_EQ(found.status, TrackingStatus::tracked) << found.why;
    EXPECT_LT(glm::length(found.world_from_camera.translation - turned.translation), 0.02);
    EXPECT_LT(rotation_angle(found.world_from_camera, turned), 0.01);
}

TEST(ReconstructRecording, WithoutDriftThereIsNothingToClose) {
    const Reconstruction result =
        reconstruct_recording(walk(0), accurate_slam(), PoseSource::tracked, to_the_end);
    EXPECT_TRUE(result.loops.empty());
    for (const ReconstructedFrame& frame : result.frames)
        EXPECT_EQ(frame.tracking.status, TrackingStatus::tracked) << frame.number;
    // Voxels of 8 mm, and noise of 3 to 8 mm that averages out over thousands of points.
    EXPECT_LT(absolute_error(poses_of(result), true_path()).rms, 0.01);
}

TEST(ReconstructRecording, ACoveredLensLosesItsFramesAlone) {
    constexpr int shown = 60;
    const FrameSource source = test::frames_from(shown, [](int i) {
        RgbdFrame frame = walk(0).load(i);
        if (i >= 25 && i < 35) frame.depth.pixels.assign(frame.depth.pixels.size(), 0.0f);
        return frame;
    });
    const Reconstruction result =
        reconstruct_recording(source, accurate_slam(), PoseSource::tracked, to_the_end);
    for (int i = 0; i < shown; ++i) {
        const ReconstructedFrame& frame = result.frames[std::size_t(i)];
        const bool covered = i >= 25 && i < 35;
        EXPECT_EQ(frame.tracking.status == TrackingStatus::lost, covered) << i;
        EXPECT_EQ(frame.fused_at.has_value(), !covered) << i;
        EXPECT_EQ(frame.tracking.why.empty(), !covered) << i;
        if (covered) continue;
        const Pose off = inverse(true_path()[std::size_t(i)]) * frame.tracking.world_from_camera;
        EXPECT_LT(glm::length(off.translation), 0.02) << i;
    }
}

TEST(ReconstructRecording, StopsWhenItIsTold) {
    int asked = 0;
    const Reconstruction result = reconstruct_recording(
        walk(0), accurate_slam(), PoseSource::tracked, [&](int) { return ++asked < 4; });
    EXPECT_FALSE(result.complete);
    EXPECT_EQ(result.frames.size(), 4U);
}

TEST(ReconstructRecording, RecordedPosesAreTakenAsTheyAre) {
    const FrameSource source = test::frames_from(12, [](int i) {
        RgbdFrame frame = walk(0).load(i);
        frame.recorded_world_from_camera = true_path()[std::size_t(i)];
        if (i == 5) frame.recorded_world_from_camera.reset();
        return frame;
    });
    const Reconstruction result =
        reconstruct_recording(source, accurate_slam(), PoseSource::recorded, to_the_end);
    for (int i = 0; i < 12; ++i) {
        const ReconstructedFrame& frame = result.frames[std::size_t(i)];
        EXPECT_EQ(frame.tracking.status == TrackingStatus::lost, i == 5);
        if (i == 5) continue;
        EXPECT_EQ(frame.tracking.world_from_camera.translation,
                  true_path()[std::size_t(i)].translation);
    }
}

}  // namespace
}  // namespace inlay
