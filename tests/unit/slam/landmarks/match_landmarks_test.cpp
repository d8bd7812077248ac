// Landmarks of a room that is known exactly, and the motions found from them.
#include "slam/landmarks/match_landmarks.h"

#include "recordings/base/parallel.h"
#include "slam/landmarks/find_landmarks.h"
#include "slam/landmarks/match_descriptors.h"
#include "slam/landmarks/solve_motion.h"
#include "tests/unit/slam/landmarks/textured_room.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace inlay {
namespace {

using test::patterned_frame;

Lens lens_of_room() { return {320, 240, 280, 280, 159.5, 119.5}; }

Lens bent_lens() {
    Lens lens = lens_of_room();
    lens.k1 = 0.2, lens.k2 = -0.5, lens.k3 = 0.3, lens.p1 = -0.003, lens.p2 = 0.002;
    return lens;
}

Pose other_pose() { return test::posed({0.08, -0.2, 0.12}, {0.25, -0.1, 0.15}); }

Landmarks landmarks_of(const RgbdFrame& frame) {
    return find_landmarks(frame.color, frame.depth, frame.lens);
}

Landmarks landmarks_from(const Pose& world_from_camera, std::uint32_t seed = 1) {
    return landmarks_of(patterned_frame(lens_of_room(), world_from_camera, seed));
}

/// Every second pixel's middle: the mean of 2 x 2 depths, as halving makes it.
Image<float> halved(const Image<float>& depth) {
    Image<float> half(depth.width / 2, depth.height / 2);
    for (int y = 0; y < half.height; ++y) {
        for (int x = 0; x < half.width; ++x) {
            half(x, y) = (depth(2 * x, 2 * y) + depth(2 * x + 1, 2 * y) + depth(2 * x, 2 * y + 1) +
                          depth(2 * x + 1, 2 * y + 1)) /
                         4;
        }
    }
    return half;
}

/// Corners are found to about half a pixel of their level, 0.7 px = 0.0025 rad on average. A turn
/// and a translation across it nearly make up for each other, so that 200 of them tell the
/// translation to 4 mm and the turn to 0.002 rad (by the normal equations); twice that is allowed.
void expect_motion(const std::optional<LandmarkMotion>& found, const Pose& truth) {
    ASSERT_TRUE(found.has_value());
    EXPECT_GE(found->inliers, 100);
    EXPECT_GE(found->pairs, found->inliers);
    EXPECT_LT(glm::length(found->from_to.translation - truth.translation), 0.008);
    EXPECT_LT(rotation_angle(found->from_to, truth), 0.004);
}

void expect_same(const Landmarks& a, const Landmarks& b) {
    EXPECT_EQ(a.pixel, b.pixel);
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.descriptor, b.descriptor);
}

void expect_nothing(const Landmarks& landmarks) {
    EXPECT_TRUE(landmarks.pixel.empty());
    EXPECT_TRUE(landmarks.position.empty());
    EXPECT_TRUE(landmarks.descriptor.empty());
}

TEST(FindLandmarks, LieOnTheSurfacesWhereTheyAreSeen) {
    for (const Lens& lens : {lens_of_room(), bent_lens()}) {
        const Landmarks found = landmarks_of(patterned_frame(lens, Pose{}, 1));
        ASSERT_GT(found.pixel.size(), 200u);
        ASSERT_EQ(found.position.size(), found.pixel.size());
        ASSERT_EQ(found.descriptor.size(), found.pixel.size());
        for (std::size_t i = 0; i < found.pixel.size(); ++i) {
            const glm::dvec3 p(found.position[i]);
            const glm::dvec2 seen = project(lens, p);
            EXPECT_LT(glm::length(seen - glm::dvec2(found.pixel[i])), 1e-3);
            // Depth between pixels rounds off the creases between walls, within a pixel's 9 mm.
            EXPECT_NEAR(test::sample_room(Pose{}, p / p.z, 1).first, p.z, 0.0045);
        }
    }
}

TEST(FindLandmarks, AreSpreadOverTheImage) {
    const Landmarks found = landmarks_from(Pose{});
    std::array<int, 12> parts{};  // 4 x 3
    ASSERT_GE(found.pixel.size(), 120u);
    for (std::size_t i = 0; i < 120; ++i)
        ++parts[std::size_t(int(found.pixel[i].y) / 80 * 4 + int(found.pixel[i].x) / 80)];
    // ORB leaves out a border of 31 px, of the parts at the corners more than half.
    EXPECT_GE(*std::min_element(parts.begin(), parts.end()), 3);
}

TEST(FindLandmarks, ImageWithoutFeaturesHasNone) {
    RgbdFrame frame = patterned_frame(lens_of_room(), Pose{}, 1);
    std::fill(frame.color.pixels.begin(), frame.color.pixels.end(), EncodedRgb{90, 120, 40});
    expect_nothing(landmarks_of(frame));
}

TEST(FindLandmarks, HolesHaveNone) {
    RgbdFrame frame = patterned_frame(lens_of_room(), Pose{}, 1);
    for (int y = 0; y < 240; ++y)
        std::fill_n(frame.depth.row(y).begin(), 160, 0.0f);
    const Landmarks found = landmarks_of(frame);
    EXPECT_GT(found.pixel.size(), 50u);
    for (const glm::vec2& pixel : found.pixel)
        EXPECT_GE(pixel.x, 160);
    std::fill(frame.depth.pixels.begin(), frame.depth.pixels.end(), 0.0f);
    expect_nothing(landmarks_of(frame));
    std::fill(frame.depth.pixels.begin(), frame.depth.pixels.end(),
              std::numeric_limits<float>::quiet_NaN());
    expect_nothing(landmarks_of(frame));
}

TEST(FindLandmarks, DepthStepsHaveNone) {
    RgbdFrame frame = patterned_frame(lens_of_room(), Pose{}, 1);
    for (int y = 0; y < 240; ++y)
        std::fill_n(frame.depth.row(y).begin(), 160, 0.4f);  // the step is between 159 and 160
    for (const glm::vec2& pixel : landmarks_of(frame).pixel)
        EXPECT_GE(std::abs(pixel.x - 159.5f), 1.5f);
}

TEST(FindLandmarks, EmptyAndTinyImagesHaveNone) {
    expect_nothing(find_landmarks({}, {}, {}));
    for (const int size : {1, 2, 63}) {
        const Lens lens{size, size, 50, 50, 0, 0};
        const Image<EncodedRgb> color(size, size, {200, 10, 10});
        expect_nothing(find_landmarks(color, Image<float>(size, size, 1.0f), lens));
    }
    const RgbdFrame frame = patterned_frame(lens_of_room(), Pose{}, 1);
    expect_nothing(find_landmarks(frame.color, {}, {}));
    expect_nothing(find_landmarks(frame.color, Image<float>(1, 1, 1.0f), {1, 1, 1, 1, 0, 0}));
}

TEST(FindLandmarks, HalfSizeDepthGivesTheSamePositions) {
    const RgbdFrame frame = patterned_frame(lens_of_room(), Pose{}, 1);
    const Landmarks full = landmarks_of(frame);
    const Landmarks half =
        find_landmarks(frame.color, halved(frame.depth), scaled(frame.lens, 160, 120));
    int shared = 0;
    for (std::size_t i = 0; i < half.pixel.size(); ++i) {
        const auto same = std::find(full.pixel.begin(), full.pixel.end(), half.pixel[i]);
        if (same == full.pixel.end()) continue;
        ++shared;
        const glm::vec3 off =
            half.position[i] - full.position[std::size_t(same - full.pixel.begin())];
        EXPECT_LT(glm::length(off), 0.002);
    }
    EXPECT_GT(shared, 150);
}

TEST(MatchLandmarks, FindsTheMotion) {
    const Landmarks from = landmarks_from(Pose{}), to = landmarks_from(other_pose());
    expect_motion(match_landmarks(from, to), other_pose());
    expect_motion(match_landmarks(to, from), inverse(other_pose()));
}

TEST(MatchLandmarks, FindsTheMotionThroughABentLens) {
    const Landmarks from = landmarks_of(patterned_frame(bent_lens(), Pose{}, 1));
    const Landmarks to = landmarks_of(patterned_frame(bent_lens(), other_pose(), 1));
    expect_motion(match_landmarks(from, to), other_pose());
}

TEST(MatchLandmarks, FindsTheMotionFromDepthOfHalfTheSize) {
    const auto half_of = [](const RgbdFrame& frame) {
        return find_landmarks(frame.color, halved(frame.depth), scaled(frame.lens, 160, 120));
    };
    const Landmarks from = half_of(patterned_frame(lens_of_room(), Pose{}, 1));
    const Landmarks to = half_of(patterned_frame(lens_of_room(), other_pose(), 1));
    expect_motion(match_landmarks(from, to), other_pose());
}

TEST(MatchLandmarks, FindsACameraUpsideDown) {
    const Pose upside_down = test::posed({0, 0, 3.1}, {0.05, 0.02, 0});
    expect_motion(match_landmarks(landmarks_from(Pose{}), landmarks_from(upside_down)),
                  upside_down);
}

TEST(MatchLandmarks, TheSameViewHasNotMoved) {
    const Landmarks view = landmarks_from(Pose{});
    const auto found = match_landmarks(view, view);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT(glm::length(found->from_to.translation), 1e-9);
    EXPECT_LT(rotation_angle(found->from_to, Pose{}), 1e-9);
}

TEST(MatchLandmarks, UnrelatedViewsHaveNoMotion) {
    const Landmarks view = landmarks_from(Pose{});
    for (const std::uint32_t seed : {2u, 3u, 4u, 5u, 6u}) {
        EXPECT_FALSE(match_landmarks(view, landmarks_from(Pose{}, seed)).has_value());
        EXPECT_FALSE(match_landmarks(landmarks_from(other_pose(), seed), view).has_value());
    }
}

TEST(MatchLandmarks, NoOrFewLandmarksTellNoMotion) {
    const Landmarks view = landmarks_from(Pose{});
    Landmarks few = view;
    for (const std::size_t count : {15u, 3u, 1u, 0u}) {
        few.pixel.resize(count);
        few.position.resize(count);
        few.descriptor.resize(count);
        EXPECT_FALSE(match_landmarks(view, few).has_value()) << count;
        EXPECT_FALSE(match_landmarks(few, view).has_value()) << count;
        EXPECT_FALSE(match_landmarks(few, few).has_value()) << count;
    }
}

TEST(MatchLandmarks, PointsOnALineOrAtOnePlaceTellNoMotion) {
    Landmarks view = landmarks_from(Pose{});
    for (std::size_t i = 0; i < view.position.size(); ++i)
        view.position[i] = {0.002f * float(i) - 0.5f, 0.1f, 2.0f};
    EXPECT_FALSE(match_landmarks(view, view).has_value());
    std::fill(view.position.begin(), view.position.end(), glm::vec3(0.1f, 0.1f, 2.0f));
    EXPECT_FALSE(match_landmarks(view, view).has_value());
}

TEST(MatchLandmarks, SameResultTwiceAndForAnyNumberOfThreads) {
    set_thread_count(1);
    const Landmarks from = landmarks_from(Pose{}), to = landmarks_from(other_pose());
    set_thread_count(3);
    expect_same(from, landmarks_from(Pose{}));
    set_thread_count(0);
    const auto once = match_landmarks(from, to), again = match_landmarks(from, to);
    ASSERT_TRUE(once && again);
    EXPECT_EQ(once->from_to.rotation, again->from_to.rotation);
    EXPECT_EQ(once->from_to.translation, again->from_to.translation);
    EXPECT_EQ(once->inliers, again->inliers);
    EXPECT_EQ(once->sigma, again->sigma);
}

TEST(Likeness, TellsTheSamePlaceFromAnother) {
    const Landmarks view = landmarks_from(Pose{});
    const int same = likeness(view, landmarks_from(test::posed({0, 0.1, 0}, {0.1, 0, 0})));
    const int other = likeness(view, landmarks_from(Pose{}, 2));
    EXPECT_GT(same, 2 * other + 10);
    EXPECT_EQ(likeness(view, {}), 0);
}

TEST(MatchDescriptors, LeavesOutWhatIsAmbiguous) {
    std::vector<LandmarkDescriptor> a(3), b;
    for (std::size_t i = 0; i < 3; ++i)
        std::fill_n(a[i].begin() + std::ptrdiff_t(10 * i), 10, std::uint8_t(0xff));
    b = {a[2], a[0], a[0]};  // two copies of the first, none of the second
    const std::vector<LandmarkPair> pairs = match_descriptors(a, b);
    ASSERT_EQ(pairs.size(), 1u);
    EXPECT_EQ(pairs[0].from, 2);
    EXPECT_EQ(pairs[0].to, 0);
    EXPECT_EQ(difference(a[0], a[1]), 160);
    EXPECT_EQ(difference(a[0], a[0]), 0);
}

/// Points before the camera at random, and where a camera at `from_to` sees them.
std::vector<PointPair> random_pairs(const Pose& from_to, int count) {
    std::vector<PointPair> pairs;
    for (std::uint32_t i = 0; i < std::uint32_t(count); ++i) {
        const auto at = [&](std::uint32_t d) { return double(uniform({7, 0, i, 0}, d)); };
        const glm::dvec3 to(at(0) - 0.5, at(1) - 0.5, 1.5 + at(2));
        pairs.push_back({from_to * to, to});
    }
    return pairs;
}

TEST(SolveMotion, IsExactForExactPairsWhateverTheOthers) {
    std::vector<PointPair> pairs = random_pairs(other_pose(), 100);
    for (std::size_t i = 0; i < 70; ++i)
        std::swap(pairs[i].to, pairs[i + 1].to);  // pairs that are wrong
    const auto start = sample_motion(pairs);
    ASSERT_TRUE(start.has_value());
    const auto solved = refine_motion(*start, pairs);
    ASSERT_TRUE(solved.has_value());
    EXPECT_GE(solved->inliers.size(), 29u);
    EXPECT_LT(glm::length(solved->from_to.translation - other_pose().translation), 1e-9);
    EXPECT_LT(rotation_angle(solved->from_to, other_pose()), 1e-9);
}

TEST(SolveMotion, TooFewPairsTellNone) {
    for (const int count : {0, 1, 3})
        EXPECT_FALSE(sample_motion(random_pairs(other_pose(), count)).has_value());
    EXPECT_FALSE(refine_motion(other_pose(), random_pairs(other_pose(), 3)).has_value());
}

}  // namespace
}  // namespace inlay
