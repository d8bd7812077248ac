// The frame loop as a whole: what must hold whatever the techniques in it do.
#include "composite/session/session.h"

#include "composite/session/named_layers.h"
#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "tests/support/tabletop.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace inlay {
namespace {

const Lens lens{96, 72, 90, 90, 47.5, 35.5};

Settings quick_settings() {
    Settings settings;
    settings.trace = with_samples(settings.trace, 4);
    settings.slam.fusion.voxel_size = 0.02f;
    settings.slam.fusion.truncation = 0.08f;
    return settings;
}

/// The last of `count` frames, composited after tracking and sampling the ones before.
OutputFrame play(const Settings& settings, const VirtualScene& objects, int count) {
    const VirtualScene room = test::tabletop();
    Session session = start_session(settings, objects, test::soft_light());
    OutputFrame out;
    for (int i = 0; i < count; ++i)
        out = advance(session, test::record_frame(room, lens, i), FrameWork::compose);
    return out;
}

template <class Pixel>
bool same_bytes(const Image<Pixel>& a, const Image<Pixel>& b) {
    return same_size(a, b) &&
           std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(Pixel)) == 0;
}

class EveryGeometry : public testing::TestWithParam<RealGeometryKind> {};

TEST_P(EveryGeometry, SameBytesForOneAndTwoThreads) {
    Settings settings = quick_settings();
    settings.geometry.kind = GetParam();
    set_thread_count(1);
    const OutputFrame one = play(settings, test::two_virtual_balls(), 3);
    set_thread_count(2);
    const OutputFrame two = play(settings, test::two_virtual_balls(), 3);
    EXPECT_TRUE(same_bytes(one.composite.display, two.composite.display));
    EXPECT_TRUE(same_bytes(one.composite.linear, two.composite.linear));
}

TEST_P(EveryGeometry, WithoutObjectsEveryByteIsTheRecordedOne) {
    Settings settings = quick_settings();
    settings.geometry.kind = GetParam();
    const OutputFrame out = play(settings, {}, 2);
    const RgbdFrame frame = test::record_frame(test::tabletop(), lens, 1);
    EXPECT_TRUE(same_bytes(out.composite.display, frame.color));
    EXPECT_EQ(out.composite.influenced_pixels, 0u);
    EXPECT_EQ(out.rays.primary, 0u);  // an empty scene traces nothing
}

TEST_P(EveryGeometry, AnObjectThatNoRayMeetsChangesNoByte) {
    Settings settings = quick_settings();
    settings.geometry.kind = GetParam();
    VirtualScene far;  // behind the camera and below the table: no ray of the room meets it, but
                       // it is too large for the plan to leave it out
    far.objects.push_back(test::ball("far", {0, -50, 0}, 0.5f, Diffuse{}, false));
    const OutputFrame out = play(settings, far, 2);
    EXPECT_GT(out.rays.primary, 0u);
    EXPECT_TRUE(
        same_bytes(out.composite.display, test::record_frame(test::tabletop(), lens, 1).color));
}

TEST_P(EveryGeometry, ASmallFarObjectOutOfViewTracesNothing) {
    Settings settings = quick_settings();
    settings.geometry.kind = GetParam();
    VirtualScene far;
    far.objects.push_back(test::ball("far", {0, 0.6, 87}, 0.1f, Diffuse{}, false));
    const OutputFrame out = play(settings, far, 2);
    EXPECT_TRUE(out.plan.names().empty());
    EXPECT_EQ(out.rays.primary, 0u);
    EXPECT_EQ(out.real, nullptr);
    EXPECT_TRUE(
        same_bytes(out.composite.display, test::record_frame(test::tabletop(), lens, 1).color));
}

TEST_P(EveryGeometry, ObjectsCastShadowsAndEveryLayerIsFinite) {
    Settings settings = quick_settings();
    settings.geometry.kind = GetParam();
    const OutputFrame out = play(settings, test::two_virtual_balls(), 3);
    EXPECT_GT(out.composite.virtual_pixels, 50u);
    EXPECT_GT(out.composite.influenced_pixels, out.composite.virtual_pixels + 50);
    EXPECT_EQ(out.composite.replaced_pixels, 0u);
    for (const Rgb& c : out.composite.linear.pixels)
        ASSERT_TRUE(std::isfinite(c.r + c.g + c.b) && c.r >= 0 && c.g >= 0 && c.b >= 0);
    const NamedLayers named = named_layers(out, layer_names());
    EXPECT_EQ(named.layers.size(), layer_names().size());
}

INSTANTIATE_TEST_SUITE_P(Real, EveryGeometry,
                         testing::Values(RealGeometryKind::screen, RealGeometryKind::map,
                                         RealGeometryKind::model));

TEST(FrameLoop, TheFrameBeforeAddsNothingToTheFirstFrame) {
    Settings still = quick_settings();
    still.filter.temporal = false;
    for (const int frames : {1, 2}) {
        const OutputFrame with = play(quick_settings(), test::two_virtual_balls(), frames);
        const OutputFrame without = play(still, test::two_virtual_balls(), frames);
        EXPECT_EQ(with.plan.has("temporal_filter"), frames == 2);
        EXPECT_FALSE(without.plan.has("temporal_filter"));
        EXPECT_EQ(same_bytes(with.composite.linear, without.composite.linear), frames == 1);
        EXPECT_EQ(with.rays.real_indirect, without.rays.real_indirect);  // it traces nothing
    }
}

TEST(FrameLoop, ThePlanFollowsAnObjectThatComesAndGoes) {
    VirtualScene objects;
    objects.objects.push_back(
        test::ball("chrome", {0, 0, 0}, 0.06f, Phong{Rgb(0.05f), Rgb(0.8f), 64}, false));
    std::vector<MotionKey>& motion = objects.objects[0].motion;
    motion.clear();
    for (int i = 0; i < 5; ++i)  // above the table, and behind the camera
        motion.push_back(
            {i / 30.0, glm::translate(glm::dmat4(1), i % 2 == 0 ? glm::dvec3(0.1, 0.06, 0)
                                                                : glm::dvec3(0, 0.7, 2))});
    Session session = start_session(quick_settings(), objects, test::soft_light());
    for (int i = 0; i < 5; ++i) {
        const OutputFrame out =
            advance(session, test::record_frame(test::tabletop(), lens, i), FrameWork::compose);
        const bool seen = i % 2 == 0;
        EXPECT_EQ(out.plan.has("virtual_surfaces"), seen) << i;
        EXPECT_EQ(out.plan.has("glossy"), seen) << i;
        EXPECT_TRUE(out.plan.has("environment_direct")) << i;
        EXPECT_EQ(out.noisy->k_v.empty(), !seen) << i;
        EXPECT_EQ(out.noisy->s_rv.empty(), !seen) << i;
        EXPECT_EQ(out.composite.virtual_pixels > 0, seen) << i;
        EXPECT_EQ(out.composite.replaced_pixels, 0u) << i;
        EXPECT_EQ(named_layers(out, layer_names()).layers.size(), layer_names().size()) << i;
    }
}

TEST(FrameLoop, AnObjectThatWasFarAwayComesBack) {
    VirtualScene objects = test::two_virtual_balls();
    for (SceneObject& object : objects.objects) {
        const glm::dmat4 here = object.motion[0].world_from_object;
        const glm::dmat4 far = glm::translate(glm::dmat4(1), glm::dvec3(0, 0.6, 87));
        object.motion = {{0, here}, {1 / 30.0, far}, {2 / 30.0, here}, {3 / 30.0, here}};
    }
    Session session = start_session(quick_settings(), objects, test::soft_light());
    for (int i = 0; i < 4; ++i) {
        const RgbdFrame frame = test::record_frame(test::tabletop(), lens, i);
        const OutputFrame out = advance(session, frame, FrameWork::compose);
        const bool far = i == 1;
        EXPECT_EQ(out.plan.names().empty(), far) << i;
        EXPECT_EQ(out.rays.primary == 0, far) << i;
        EXPECT_EQ(same_bytes(out.composite.display, frame.color), far) << i;
        EXPECT_EQ(out.plan.has("temporal_filter"), i == 3) << i;  // else there is no frame before
        EXPECT_EQ(session.previous == nullptr, far) << i;
        EXPECT_EQ(out.composite.virtual_pixels > 0, !far) << i;
        EXPECT_EQ(out.composite.replaced_pixels, 0u) << i;
        EXPECT_EQ(named_layers(out, layer_names()).layers.size(), layer_names().size()) << i;
    }
}

TEST(FrameLoop, ALostFrameShowsThePhotographAlone) {
    Session session =
        start_session(quick_settings(), test::two_virtual_balls(), test::soft_light());
    const RgbdFrame first = test::record_frame(test::tabletop(), lens, 0);
    advance(session, first, FrameWork::compose);
    RgbdFrame blind = first;
    blind.index = 1;
    blind.depth = Image<float>(lens.width, lens.height, 0.0f);
    const OutputFrame out = advance(session, blind, FrameWork::compose);
    EXPECT_EQ(out.tracking.status, TrackingStatus::lost);
    EXPECT_TRUE(same_bytes(out.composite.display, blind.color));
    EXPECT_TRUE(out.plan.names().empty());
}

TEST(FrameLoop, WithRecordedPosesAFrameWithoutOneIsLostAndTeachesNothing) {
    Settings settings = quick_settings();
    settings.use_recorded_poses = true;
    const auto frame = [](int number, bool posed) {
        RgbdFrame recorded = test::record_frame(test::tabletop(), lens, number);
        if (!posed) recorded.recorded_world_from_camera.reset();
        return recorded;
    };
    Session some = start_session(settings, test::two_virtual_balls(), test::soft_light());
    Session all = start_session(settings, test::two_virtual_balls(), test::soft_light());
    const OutputFrame first = advance(some, frame(0, false), FrameWork::compose);
    EXPECT_EQ(first.tracking.status, TrackingStatus::lost);
    EXPECT_TRUE(some.slam.volume.bricks.empty());
    EXPECT_GT(advance(some, frame(1, true), FrameWork::compose).composite.influenced_pixels, 0u);
    advance(all, frame(1, true), FrameWork::compose);
    const OutputFrame lost = advance(some, frame(2, false), FrameWork::compose);
    EXPECT_EQ(lost.tracking.status, TrackingStatus::lost);
    EXPECT_TRUE(same_bytes(lost.composite.display, frame(2, true).color));
    EXPECT_EQ(lost.rays.primary, 0u);
    // the same model as if the lost frames had not been there
    EXPECT_EQ(some.slam.volume.bricks.size(), all.slam.volume.bricks.size());
    EXPECT_EQ(some.slam.frames_lost, 0);
}

TEST(FrameLoop, AFrameIsTheSameWhetherOrNotTheOnesBeforeWereShown) {
    const VirtualScene room = test::tabletop();
    const OutputFrame all = play(quick_settings(), test::two_virtual_balls(), 4);
    Session session =
        start_session(quick_settings(), test::two_virtual_balls(), test::soft_light());
    const FrameWork work[] = {FrameWork::track, FrameWork::track, FrameWork::sample,
                              FrameWork::compose};
    OutputFrame out;
    for (int i = 0; i < 4; ++i)
        out = advance(session, test::record_frame(room, lens, i), work[i]);
    EXPECT_TRUE(same_bytes(all.composite.display, out.composite.display));
}

TEST(Settings, EveryRowReadsBackWhatItWrites) {
    for (const SettingRow& row : setting_rows()) {
        Settings settings;
        row.set(settings, row.get(settings));
        EXPECT_EQ(row.get(settings), row.get(Settings{})) << row.name;
        EXPECT_THROW(row.set(settings, "nonsense"), Error) << row.name;
    }
}

TEST(Settings, AnUnknownNameSuggestsTheNearest) {
    Settings settings;
    try {
        apply_setting(settings, "filter.kernel_radus=3");
        FAIL() << "was accepted";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("filter.kernel_radius"), std::string::npos);
        EXPECT_EQ(error.code(), ExitCode::usage);
    }
}

}  // namespace
}  // namespace inlay
