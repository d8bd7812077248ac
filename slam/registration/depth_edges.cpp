#include "slam/registration/depth_edges.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace inlay {
namespace {

constexpr int margin = 6;                 // px
constexpr float noisy_from = 1.5f;        // m; beyond, the least relative step grows with depth
constexpr float shadow_tolerance = 1.3f;  // of a shadow's computed width
constexpr double smoothing = 2.0;         // px, standard deviation, before the normal is taken
constexpr float least_agreement = 0.35f;  // of the normal with the direction of the step, a cosine
constexpr float least_gradient = 1e-6f;   // 1/m per px (Sobel sum); below, there is no direction

/// In which directions of a pixel the far surface lies.
enum Side : std::uint8_t { right = 1, left = 2, below = 4, above = 8 };

/// A row or a column of the image.
struct Line {
    std::size_t first, stride;
    int count;
    std::uint8_t ahead, behind;  // Side
    float shadow;                // px m: width of a shadow per difference of inverse depth
    std::size_t at(int i) const { return first + stride * std::size_t(i); }
};

struct Scan {
    Image<float> filled;        // m, holes have the depth of the farther side; 0: open holes
    Image<std::uint8_t> sides;  // Side, of the near pixel beside a step
};

bool measured(float z) { return z > 0 && std::isfinite(z); }

bool is_step(float near, float far, const DepthEdgeSettings& s) {
    const float relative = s.relative_step * near * std::max(1.0f, near / noisy_from);
    return far - near > std::max(s.step, relative);
}

/// Looks at two pixels between which nothing is measured.
void compare(Scan& scan, const Line& line, int a, int b, const DepthEdgeSettings& settings) {
    const float za = scan.filled.pixels[line.at(a)], zb = scan.filled.pixels[line.at(b)];
    const float near = std::min(za, zb), far = std::max(za, zb);
    const float shadow = line.shadow * (1 / near - 1 / far);
    if (is_step(near, far, settings) &&
        float(b - a - 1) <= float(settings.hole) + shadow_tolerance * shadow) {
        scan.sides.pixels[line.at(za < zb ? a : b)] |= za < zb ? line.ahead : line.behind;
    }
}

void scan_line(Scan& scan, const Image<float>& depth, const Line& line,
               const DepthEdgeSettings& settings) {
    int last = -1;
    for (int i = 0; i < line.count; ++i) {
        if (!measured(depth.pixels[line.at(i)])) continue;
        if (last >= 0) {
            compare(scan, line, last, i, settings);
            const float far = std::max(depth.pixels[line.at(last)], depth.pixels[line.at(i)]);
            for (int hole = last + 1; hole < i; ++hole) {
                float& filled = scan.filled.pixels[line.at(hole)];
                filled = std::max(filled, far);
            }
        }
        last = i;
    }
}

Scan scan_image(const Image<float>& depth, double focal_length, const DepthEdgeSettings& settings) {
    Scan scan{depth, Image<std::uint8_t>(depth.width, depth.height)};
    for (float& z : scan.filled.pixels)
        if (!measured(z)) z = 0;
    const float shadow = float(std::abs(focal_length)) * settings.shadow_baseline;
    const auto width = std::size_t(depth.width);
    for (int y = 0; y < depth.height; ++y)
        scan_line(scan, depth, {width * std::size_t(y), 1, depth.width, right, left, shadow},
                  settings);
    for (int x = 0; x < depth.width; ++x)
        scan_line(scan, depth, {std::size_t(x), width, depth.height, below, above, 0}, settings);
    return scan;
}

/// Inverse depth (1/m), smoothed over what is known.
cv::Mat1f smooth_inverse_depth(const Image<float>& filled) {
    cv::Mat1f inverse(filled.height, filled.width), known(filled.height, filled.width);
    for (int y = 0; y < filled.height; ++y) {
        for (int x = 0; x < filled.width; ++x) {
            const float z = filled(x, y);
            known(y, x) = z > 0 ? 1.0f : 0.0f;
            inverse(y, x) = z > 0 ? 1 / std::max(z, 0.1f) : 0.0f;
        }
    }
    cv::GaussianBlur(inverse, inverse, {}, smoothing);
    cv::GaussianBlur(known, known, {}, smoothing);
    for (int y = 0; y < filled.height; ++y) {
        for (int x = 0; x < filled.width; ++x)
            inverse(y, x) /= std::max(known(y, x), 1e-3f);
    }
    return inverse;
}

/// 1 where a pixel belongs to a rim that is long enough and in range.
cv::Mat1b long_rims(const Image<float>& depth, const Image<std::uint8_t>& sides,
                    const DepthEdgeSettings& settings) {
    cv::Mat1b rims(depth.height, depth.width, std::uint8_t(0));
    for (int y = margin; y < depth.height - margin; ++y) {
        for (int x = margin; x < depth.width - margin; ++x) {
            const float z = depth(x, y);
            rims(y, x) = sides(x, y) != 0 && z > settings.nearest && z < settings.farthest;
        }
    }
    cv::Mat labels, figures, centres;
    cv::connectedComponentsWithStats(rims, labels, figures, centres, 8);
    for (int y = margin; y < depth.height - margin; ++y) {
        for (int x = margin; x < depth.width - margin; ++x) {
            const int length = figures.at<int>(labels.at<int>(y, x), cv::CC_STAT_AREA);
            if (length < settings.least_length) rims(y, x) = 0;
        }
    }
    return rims;
}

bool agrees(std::uint8_t sides, const glm::vec2& normal) {
    return ((sides & right) && normal.x > least_agreement) ||
           ((sides & left) && normal.x < -least_agreement) ||
           ((sides & below) && normal.y > least_agreement) ||
           ((sides & above) && normal.y < -least_agreement);
}

}  // namespace

std::vector<DepthEdge> depth_edges(const Image<float>& depth, double focal_length,
                                   const DepthEdgeSettings& settings) {
    std::vector<DepthEdge> edges;
    if (depth.width <= 2 * margin || depth.height <= 2 * margin) return edges;
    const Scan scan = scan_image(depth, focal_length, settings);
    const cv::Mat1b rims = long_rims(depth, scan.sides, settings);
    const cv::Mat1f inverse = smooth_inverse_depth(scan.filled);
    cv::Mat1f gx, gy;
    cv::Sobel(inverse, gx, CV_32F, 1, 0);
    cv::Sobel(inverse, gy, CV_32F, 0, 1);
    for (int y = margin; y < depth.height - margin; ++y) {
        for (int x = margin; x < depth.width - margin; ++x) {
            if (rims(y, x) == 0) continue;
            const glm::vec2 gradient(gx(y, x), gy(y, x));
            const float slope = glm::length(gradient);
            if (!(slope > least_gradient)) continue;
            const glm::vec2 normal = -gradient / slope;
            if (agrees(scan.sides(x, y), normal)) edges.push_back({{x, y}, depth(x, y), normal});
        }
    }
    return edges;
}

}  // namespace inlay
