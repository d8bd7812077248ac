#include "slam/landmarks/find_landmarks.h"

#include "slam/depth/filter_depth.h"

#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace inlay {
namespace {

constexpr int most_landmarks = 700;
constexpr int most_corners = 3000;  // of which they are chosen
constexpr int cells_x = 8, cells_y = 6;
constexpr int levels = 5;            // of the image pyramid
constexpr double level_scale = 1.2;  // between levels
constexpr int least_contrast = 8;    // of 255, between a corner and the circle around it
constexpr int least_size = 64;       // px; smaller images hold no whole neighbourhood of a corner
constexpr float least_distance = 3;  // px between landmarks
constexpr float margin = 2;          // px of the color image around a corner without a depth step

cv::Mat1b grey_image(const Image<EncodedRgb>& color) {
    static_assert(sizeof(EncodedRgb) == 3);
    cv::Mat3b rgb(color.height, color.width);
    std::memcpy(rgb.data, color.pixels.data(), color.pixels.size() * 3);
    cv::Mat1b grey;
    cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
    return grey;
}

cv::Ptr<cv::ORB> corner_finder() {
    constexpr int border = 31, first_level = 0, comparisons = 2, patch = 31;
    return cv::ORB::create(most_corners, float(level_scale), levels, border, first_level,
                           comparisons, cv::ORB::HARRIS_SCORE, patch, least_contrast);
}

/// The image position (px) of a corner. ORB multiplies positions by the level's scale, which moves
/// the centers of pixels towards the origin.
glm::vec2 pixel_of(const cv::KeyPoint& corner) {
    const float scale = float(std::pow(level_scale, corner.octave));
    return glm::vec2(corner.pt.x, corner.pt.y) + 0.5f * (scale - 1);
}

/// Depth (m) between pixels, bilinear; empty where one is not measured or there is a step near.
std::optional<float> smooth_depth_at(const Image<float>& depth, const glm::dvec2& p, int radius) {
    const int x0 = int(std::floor(p.x)), y0 = int(std::floor(p.y));
    const glm::ivec2 from(x0 - radius + 1, y0 - radius + 1), to(x0 + radius, y0 + radius);
    if (!depth.contains(from.x, from.y) || !depth.contains(to.x, to.y)) return std::nullopt;
    const float z00 = depth(x0, y0), z10 = depth(x0 + 1, y0);
    const float z01 = depth(x0, y0 + 1), z11 = depth(x0 + 1, y0 + 1);
    if (!(z00 > 0 && z10 > 0 && z01 > 0 && z11 > 0)) return std::nullopt;
    const float step = depth_step(z00, DepthSettings{});
    for (int y = from.y; y <= to.y; ++y) {
        for (int x = from.x; x <= to.x; ++x) {
            const float z = depth(x, y);
            if (z > 0 && std::abs(z - z00) > step) return std::nullopt;
        }
    }
    const float a = float(p.x - x0), b = float(p.y - y0);
    return (z00 * (1 - a) + z10 * a) * (1 - b) + (z01 * (1 - a) + z11 * a) * b;
}

struct Corner {
    cv::KeyPoint key;
    glm::vec2 pixel{0};     // px of the color image
    glm::vec3 position{0};  // m, camera frame
};

/// The corners that have a depth.
std::vector<Corner> placed(const std::vector<cv::KeyPoint>& keys, const Image<float>& depth,
                           const Lens& lens, const glm::dvec2& depth_per_color) {
    const int radius = std::max(1, int(std::lround(margin * depth_per_color.x)));
    std::vector<Corner> corners;
    for (const cv::KeyPoint& key : keys) {
        const glm::vec2 pixel = pixel_of(key);
        const glm::dvec2 p = (glm::dvec2(pixel) + 0.5) * depth_per_color - 0.5;
        if (const auto z = smooth_depth_at(depth, p, radius))
            corners.push_back({key, pixel, glm::vec3(double(*z) * unproject(lens, p))});
    }
    return corners;
}

/// Corners by descending strength, cell by cell; those next to a stronger one are left out.
std::vector<std::vector<Corner>> by_cell(std::vector<Corner> corners, int width, int height) {
    std::stable_sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) {
        return a.key.response > b.key.response;
    });
    const int taken_width = int(float(width) / least_distance) + 1;
    Image<std::uint8_t> taken(taken_width, int(float(height) / least_distance) + 1, 0);
    std::vector<std::vector<Corner>> cells(cells_x * cells_y);
    for (const Corner& corner : corners) {
        const glm::ivec2 place(corner.pixel / least_distance);
        if (!taken.contains(place.x, place.y) || taken(place.x, place.y)) continue;
        taken(place.x, place.y) = 1;
        const int x = std::min(cells_x - 1, int(corner.pixel.x) * cells_x / width);
        const int y = std::min(cells_y - 1, int(corner.pixel.y) * cells_y / height);
        cells[std::size_t(y * cells_x + x)].push_back(corner);
    }
    return cells;
}

/// The strongest of each cell, then the second strongest, and so on.
std::vector<Corner> spread(const std::vector<std::vector<Corner>>& cells) {
    std::vector<Corner> chosen;
    bool more = true;
    for (std::size_t rank = 0; more; ++rank) {
        more = false;
        for (const std::vector<Corner>& cell : cells) {
            if (rank >= cell.size()) continue;
            if (chosen.size() == most_landmarks) return chosen;
            chosen.push_back(cell[rank]);
            more = true;
        }
    }
    return chosen;
}

/// Computes the descriptors. ORB may change the corners' order: `class_id` tells which is which.
Landmarks described(const cv::Mat1b& grey, std::vector<Corner> corners, cv::ORB& orb) {
    std::vector<cv::KeyPoint> keys;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i].key.class_id = int(i);
        keys.push_back(corners[i].key);
    }
    cv::Mat1b rows;
    orb.compute(grey, keys, rows);
    std::vector<std::optional<LandmarkDescriptor>> descriptors(corners.size());
    for (std::size_t row = 0; row < keys.size(); ++row) {
        LandmarkDescriptor& descriptor = descriptors[std::size_t(keys[row].class_id)].emplace();
        std::memcpy(descriptor.data(), rows.ptr(int(row)), descriptor.size());
    }
    Landmarks landmarks;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        if (!descriptors[i]) continue;
        landmarks.pixel.push_back(corners[i].pixel);
        landmarks.position.push_back(corners[i].position);
        landmarks.descriptor.push_back(*descriptors[i]);
    }
    return landmarks;
}

}  // namespace

Landmarks find_landmarks(const Image<EncodedRgb>& color, const Image<float>& depth,
                         const Lens& lens) {
    if (std::min(color.width, color.height) < least_size || depth.empty()) return {};
    const cv::Mat1b grey = grey_image(color);
    const cv::Ptr<cv::ORB> orb = corner_finder();
    std::vector<cv::KeyPoint> keys;
    orb->detect(grey, keys);
    const glm::dvec2 depth_per_color(double(depth.width) / color.width,
                                     double(depth.height) / color.height);
    const auto corners = placed(keys, depth, lens, depth_per_color);
    return described(grey, spread(by_cell(corners, color.width, color.height)), *orb);
}

}  // namespace inlay
