#include "slam/mapping/keyframes.h"

#include "slam/landmarks/match_landmarks.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace inlay {
namespace {

constexpr int thumbnail_width = 32, thumbnail_height = 24;  // blocks
constexpr double least_distance = 0.25;                     // m
constexpr double least_angle = 0.26;                        // rad
constexpr float least_filled = 0.25f;  // share of a block that must be measured
constexpr int views_matched = 5;       // that have most landmarks in common

float block_mean(const Image<float>& depth, const glm::ivec2& from, const glm::ivec2& to) {
    float sum = 0;
    int count = 0;
    for (int y = from.y; y < to.y; ++y) {
        for (int x = from.x; x < to.x; ++x) {
            if (depth(x, y) == 0) continue;
            sum += 1 / depth(x, y);
            ++count;
        }
    }
    const int pixels = (to.x - from.x) * (to.y - from.y);
    return float(count) > least_filled * float(pixels) ? sum / float(count) : 0.0f;
}

/// Mean absolute difference of inverse depth (1/m) over the blocks that either view measured;
/// a block that only one of them measured counts as 1/m.
float difference(const Image<float>& a, const Image<float>& b) {
    float sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const float p = a.pixels[i], q = b.pixels[i];
        if (p == 0 && q == 0) continue;
        sum += p > 0 && q > 0 ? std::min(1.0f, std::abs(p - q)) : 1.0f;
        ++count;
    }
    return count > 0 ? sum / float(count) : 1.0f;
}

/// The places of the keyframes, those of the lowest rank first.
template <class Rank>
std::vector<std::size_t> by_rank(const std::vector<Keyframe>& keyframes, Rank rank) {
    std::vector<decltype(rank(keyframes.front()))> ranks;
    for (const Keyframe& kept : keyframes)
        ranks.push_back(rank(kept));
    std::vector<std::size_t> order(keyframes.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return ranks[a] < ranks[b]; });
    return order;
}

}  // namespace

Image<float> make_thumbnail(const Image<float>& depth) {
    Image<float> thumbnail(thumbnail_width, thumbnail_height);
    for (int y = 0; y < thumbnail_height; ++y) {
        for (int x = 0; x < thumbnail_width; ++x) {
            const glm::ivec2 from(x * depth.width / thumbnail_width,
                                  y * depth.height / thumbnail_height);
            const glm::ivec2 to((x + 1) * depth.width / thumbnail_width,
                                (y + 1) * depth.height / thumbnail_height);
            thumbnail(x, y) = block_mean(depth, from, to);
        }
    }
    return thumbnail;
}

bool remember_view(std::vector<Keyframe>& keyframes, const Pose& world_from_camera,
                   const Image<float>& depth) {
    for (const Keyframe& kept : keyframes) {
        const double distance =
            glm::length(kept.world_from_camera.translation - world_from_camera.translation);
        const double angle = rotation_angle(kept.world_from_camera, world_from_camera);
        if (distance < least_distance && angle < least_angle) return false;
    }
    keyframes.push_back({world_from_camera, make_thumbnail(depth)});
    return true;
}

std::vector<Pose> similar_views(const std::vector<Keyframe>& keyframes, const Image<float>& depth,
                                int count) {
    const Image<float> thumbnail = make_thumbnail(depth);
    std::vector<Pose> poses;
    for (const std::size_t i : by_rank(keyframes, [&](const Keyframe& kept) {
             return difference(thumbnail, kept.thumbnail);
         })) {
        if (int(poses.size()) < count) poses.push_back(keyframes[i].world_from_camera);
    }
    return poses;
}

std::vector<Pose> poses_by_landmarks(const std::vector<Keyframe>& keyframes,
                                     const Landmarks& landmarks, int count) {
    std::vector<Pose> poses;
    if (landmarks.descriptor.empty()) return poses;
    int tried = 0;
    for (const std::size_t i : by_rank(keyframes, [&](const Keyframe& kept) {
             return -likeness(kept.landmarks, landmarks);
         })) {
        if (++tried > views_matched || int(poses.size()) == count) break;
        if (const auto motion = match_landmarks(keyframes[i].landmarks, landmarks))
            poses.push_back(keyframes[i].world_from_camera * motion->from_to);
    }
    return poses;
}

}  // namespace inlay
