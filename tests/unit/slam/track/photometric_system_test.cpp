// The photometric system against its own cost and known motions, and the tracker on a plane, which
// only its texture can tell it about.
#include "slam/track/photometric_system.h"

#include "recordings/base/parallel.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/mapping/advance_slam.h"
#include "slam/track/filled_step.h"
#include "tests/unit/slam/track/textured_plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>

namespace inlay {
namespace {

using test::PlaneFaults;

/// What a camera saw, at one level.
struct View {
    SurfaceMap surface;
    BrightnessMap brightness;

    explicit View(const RgbdFrame& frame)
        : surface(surface_from_depth(frame.depth, frame.lens, Pose{})),
          brightness(brightness_pyramid(frame.color, std::span(&frame.lens, 1)).front()) {}

    SeenBrightness seen() const { return {surface, brightness}; }
};

View view_of(int index, const Pose& world_from_camera, const PlaneFaults& faults = {}) {
    return View(test::plane_frame(index, world_from_camera, faults));
}

Pose shifted(double x, double y) { return {glm::dmat3(1.0), {x, y, 0}}; }

/// Steps from where the model is until they end, each in the directions that surface or brightness
/// constrain; and how many stay free.
struct Found {
    Pose model_from_observed;
    int free_axes = 6;
};

Found aligned(const View& observed, const View& model) {
    Found found;
    for (int i = 0; i < 8; ++i) {
        const Pose& pose = found.model_from_observed;
        const IcpSystem icp = icp_system(observed.surface, model.surface, pose, {0.1f, 0.8f, 5});
        const BrightnessSettings settings = adapted({}, observed.seen(), model.seen(), pose);
        const PhotometricSystem light =
            photometric_system(observed.seen(), model.seen(), pose, settings);
        const ConstrainedStep step = filled_step(constrained_step(icp, 5e-4), icp, light, {});
        found = {exponential(step.twist) * pose, step.free_axes};
    }
    return found;
}

double error_of(const Found& found, const Pose& truth) {
    return glm::length(found.model_from_observed.translation - truth.translation);
}

/// Half the cost at the best gain: it is a parabola over the gain.
double cost(const View& observed, const View& model, const Pose& pose,
            BrightnessSettings settings) {
    std::array<double, 3> at{};
    for (int i = 0; i < 3; ++i) {
        settings.gain = 0.5f + 0.5f * float(i);
        at[std::size_t(i)] =
            photometric_system(observed.seen(), model.seen(), pose, settings).squared_residual;
    }
    const double bend = at[0] - 2 * at[1] + at[2], slope = (at[2] - at[0]) / 2;
    const double scale = double(settings.scale);
    return (at[1] - slope * slope / (2 * bend)) / (2 * scale * scale);
}

TEST(PhotometricSystem, DescendsItsOwnCost) {
    const View model = view_of(0, Pose{}), observed = view_of(1, shifted(0.004, -0.003));
    // All pixels count, and all alike; but points come and go at the image's border, as many on
    // one side of the difference quotient as on the other.
    const BrightnessSettings settings{0.2f, 0, 1, 100};
    const PhotometricSystem system =
        photometric_system(observed.seen(), model.seen(), Pose{}, settings);
    const double h = 2e-4;
    for (std::size_t i = 0; i < 6; ++i) {
        Twist ahead;
        (i < 3 ? ahead.rotation[int(i)] : ahead.translation[int(i) - 3]) = h;
        const Twist behind{-ahead.rotation, -ahead.translation};
        const double descent = (cost(observed, model, exponential(behind), settings) -
                                cost(observed, model, exponential(ahead), settings)) /
                               (2 * h);
        // Central differences flatten the shortest wave (10 px) by 6 %, longer ones less.
        const double size = std::sqrt(system.b[3] * system.b[3] + system.b[4] * system.b[4]);
        EXPECT_NEAR(system.b[i], descent, 0.08 * size) << i;
    }
}

TEST(PhotometricSystem, RecoversAMotionAlongAPlane) {
    const View model = view_of(0, Pose{});
    for (const Pose& truth : {shifted(0.001, 0), shifted(-0.006, 0.004), test::plane_pose(1)}) {
        const Found found = aligned(view_of(1, truth), model);
        EXPECT_EQ(found.free_axes, 0);
        // A pixel is 3.8 mm wide there; a fiftieth of it is left by rounding to 8 bits and by
        // interpolation.
        EXPECT_LT(error_of(found, truth), 8e-5);
        EXPECT_LT(rotation_angle(found.model_from_observed, truth), 1e-4);
    }
}

TEST(PhotometricSystem, AUniformWallTellsNothing) {
    const PlaneFaults faults{0, 2, 1, 0};
    const View model = view_of(0, Pose{}, faults);
    const View observed = view_of(1, shifted(0.002, 0), faults);
    const PhotometricSystem system = photometric_system(observed.seen(), model.seen(), Pose{}, {});
    EXPECT_GT(system.seen, 70000);
    EXPECT_LT(system.pairs, system.seen / 100);  // the noise of the photographs seldom slopes so
    const Found found = aligned(observed, model);
    EXPECT_EQ(found.free_axes, 3);
    EXPECT_LT(glm::length(found.model_from_observed.translation), 1e-5);
}

TEST(PhotometricSystem, AnotherExposureIsNoMotion) {
    const View model = view_of(0, Pose{});
    const Pose truth = shifted(0.003, 0.001);
    for (const float exposure : {0.7f, 1.25f}) {
        const View observed = view_of(1, truth, {0, 0, exposure, 0.5f});
        const BrightnessSettings settings = adapted({}, observed.seen(), model.seen(), truth);
        EXPECT_NEAR(settings.gain, 1 / std::sqrt(exposure), 0.01);
        EXPECT_LT(error_of(aligned(observed, model), truth), 1e-4);  // as without, and rounding
    }
}

TEST(PhotometricSystem, OutliersHardlyBias) {
    const View model = view_of(0, Pose{});
    const Pose truth = shifted(0.002, 0);
    RgbdFrame frame = test::plane_frame(1, truth, {});
    for (int y = 60; y < 180; ++y)
        for (int x = 100; x < 228; ++x)  // 20 % of the image: a bright thing with a ramp
            frame.color(x, y) = {std::uint8_t(x), std::uint8_t(255 - y), 250};
    // The biweight drops what differs by more than 4.7 scales; where thing and plane are as bright
    // by chance, its ramp pulls: 1/10 of a pixel at most.
    EXPECT_LT(error_of(aligned(View(frame), model), truth), 4e-4);
}

TEST(PhotometricSystem, LeavesHolesOut) {
    const View model = view_of(0, Pose{});
    const Pose truth = shifted(0.002, 0);
    RgbdFrame frame = test::plane_frame(1, truth, {});
    for (int y = 0; y < 240; y += 3) {
        frame.depth(y, y) = 0;
        frame.depth(y + 40, y) = std::numeric_limits<float>::quiet_NaN();
        frame.color(y + 80, y) = {};
    }
    const View observed(frame);
    const PhotometricSystem system = photometric_system(observed.seen(), model.seen(), truth, {});
    for (const double entry : system.a)
        EXPECT_TRUE(std::isfinite(entry));
    EXPECT_GT(system.inliers, 50000);
    EXPECT_LT(error_of(aligned(observed, model), truth), 1e-4);
    View blind = model;
    blind.brightness.pixels = Image<Brightness>(320, 240);
    EXPECT_EQ(photometric_system(observed.seen(), blind.seen(), truth, {}).seen, 0);
    EXPECT_EQ(aligned(observed, blind).free_axes, 3);
}

TEST(PhotometricSystem, SameBytesForAnyNumberOfThreads) {
    const View model = view_of(0, Pose{}), observed = view_of(1, shifted(0.002, 0), {0, 2, 1, 1});
    const auto computed = [&](int threads) {
        set_thread_count(threads);
        const BrightnessSettings settings = adapted({}, observed.seen(), model.seen(), Pose{});
        return photometric_system(observed.seen(), model.seen(), Pose{}, settings);
    };
    const PhotometricSystem one = computed(1), three = computed(3);
    set_thread_count(0);
    EXPECT_EQ(std::memcmp(one.a.data(), three.a.data(), sizeof(one.a)), 0);
    EXPECT_EQ(std::memcmp(one.b.data(), three.b.data(), sizeof(one.b)), 0);
    EXPECT_EQ(one.inliers, three.inliers);
}

TEST(BrightnessMap, SlopesPerUnitOfTheRay) {
    Image<EncodedRgb> ramp(64, 48);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x) {
            const float value = 0.3f + 0.005f * float(x);
            ramp(x, y) = encode(Rgb(value * value));
        }
    const Lens lens{64, 48, 50, 50, 31.5, 23.5};
    const BrightnessMap map = brightness_pyramid(ramp, std::span(&lens, 1)).front();
    double mean = 0;
    for (int x = 10; x < 50; ++x)
        mean += double(map.pixels(x, 20).slope.x) / 40;
    EXPECT_NEAR(mean, 0.005 * 50, 0.005);  // bytes are rounded by 0.002 at both ends of 40 px
    EXPECT_NEAR(map.pixels(30, 20).slope.y, 0, 1e-6);
    EXPECT_EQ(map.pixels(0, 20).value, 0);  // the border is not known
}

/// The farthest that tracking gets from the truth (m) along the plane, in 12 frames with noise in
/// depth and color, while the exposure grows by 20 %.
double drift(float contrast) {
    SlamState state = start_slam(accurate_slam());
    double farthest = 0;
    for (int i = 0; i < 12; ++i) {
        const PlaneFaults faults{0.001f, 2, 1 + 0.2f * float(i) / 11, contrast};
        const Pose truth = test::plane_pose(i);
        const TrackResult result = track_and_fuse(state, test::plane_frame(i, truth, faults),
                                                  accurate_slam(), std::nullopt);
        EXPECT_EQ(result.status, TrackingStatus::tracked);
        farthest = std::max(farthest,
                            glm::length(result.world_from_camera.translation - truth.translation));
    }
    return farthest;
}

TEST(TrackFrame, FollowsThePlaneByItsTexture) {
    EXPECT_LT(drift(0.5f), 1e-3);  // a quarter of a pixel
    EXPECT_GT(drift(0), 0.05);     // a uniform wall: it believes that it stands still, 5.5 cm off
}

}  // namespace
}  // namespace inlay
