#include "slam/registration/color_edges.h"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace inlay {
namespace {

constexpr double smoothing = 1.0;  // px, standard deviation
constexpr double sobel_sum = 8.0;  // weights of Sobel's 3 x 3 kernel on either side, times 2 px
constexpr float least_gradient = 3.0f;  // of 255 per px; less is noise
constexpr double weak_share = 0.76;     // of all pixels have too little gradient for an edge
constexpr int least_length = 8;         // px

Image<glm::vec2> strongest_gradient(const Image<EncodedRgb>& color) {
    cv::Mat3b smooth(color.height, color.width);
    static_assert(sizeof(EncodedRgb) == 3);
    std::copy_n(&color.pixels.front().r, color.pixels.size() * 3, smooth.data);
    cv::GaussianBlur(smooth, smooth, {}, smoothing);
    cv::Mat3f gx, gy;
    cv::Sobel(smooth, gx, CV_32F, 1, 0, 3, 1 / sobel_sum);
    cv::Sobel(smooth, gy, CV_32F, 0, 1, 3, 1 / sobel_sum);
    Image<glm::vec2> gradient(color.width, color.height);
    for (int y = 0; y < color.height; ++y) {
        for (int x = 0; x < color.width; ++x) {
            glm::vec2& strongest = gradient(x, y);
            for (int channel = 0; channel < 3; ++channel) {
                const glm::vec2 g(gx(y, x)[channel], gy(y, x)[channel]);
                if (glm::dot(g, g) > glm::dot(strongest, strongest)) strongest = g;
            }
        }
    }
    return gradient;
}

Image<float> length_of(const Image<glm::vec2>& gradient) {
    Image<float> length(gradient.width, gradient.height);
    std::transform(gradient.pixels.begin(), gradient.pixels.end(), length.pixels.begin(),
                   [](const glm::vec2& g) { return std::sqrt(g.x * g.x + g.y * g.y); });
    return length;
}

/// Gradient (of 255 per px) that an edge must exceed.
float threshold_of(const Image<float>& length) {
    std::vector<float> sample;  // of every fourth pixel each way
    for (int y = 0; y < length.height; y += 4) {
        for (int x = 0; x < length.width; x += 4)
            sample.push_back(length(x, y));
    }
    const auto quantile = sample.begin() + std::ptrdiff_t(weak_share * double(sample.size() - 1));
    std::nth_element(sample.begin(), quantile, sample.end());
    return std::max(least_gradient, *quantile);
}

/// The image between pixels, bilinear. (x, y) must have a pixel to its right and below.
float between(const Image<float>& image, float x, float y) {
    const int i = int(x), j = int(y);
    const float a = x - float(i), b = y - float(j);
    const float* p = &image(i, j);
    const float* q = p + image.width;
    return (p[0] * (1 - a) + p[1] * a) * (1 - b) + (q[0] * (1 - a) + q[1] * a) * b;
}

/// 255 on the ridges of the gradient's length.
cv::Mat1b ridges(const Image<glm::vec2>& gradient) {
    const Image<float> length = length_of(gradient);
    const float threshold = threshold_of(length);
    cv::Mat1b edges(length.height, length.width, std::uint8_t(0));
    for (int y = 2; y < length.height - 2; ++y) {
        for (int x = 2; x < length.width - 2; ++x) {
            const float m = length(x, y);
            if (!(m > threshold)) continue;
            const glm::vec2 step = gradient(x, y) / m, here(x, y);
            const glm::vec2 up = here + step, down = here - step;
            if (m >= between(length, up.x, up.y) && m > between(length, down.x, down.y))
                edges(y, x) = 255;
        }
    }
    return edges;
}

void drop_short(cv::Mat1b& edges) {
    cv::Mat labels, figures, centres;
    cv::connectedComponentsWithStats(edges, labels, figures, centres, 8);
    for (int y = 0; y < edges.rows; ++y) {
        for (int x = 0; x < edges.cols; ++x) {
            const int length = figures.at<int>(labels.at<int>(y, x), cv::CC_STAT_AREA);
            if (length < least_length) edges(y, x) = 0;
        }
    }
}

Image<std::uint8_t> distance_from(const cv::Mat1b& elsewhere) {
    cv::Mat1f px;
    cv::distanceTransform(elsewhere, px, cv::DIST_L2, 5);
    Image<std::uint8_t> distance(px.cols, px.rows);
    for (int y = 0; y < px.rows; ++y) {
        for (int x = 0; x < px.cols; ++x) {
            distance(x, y) =
                std::uint8_t(edge_distance_steps * std::min(double(px(y, x)), farthest_edge));
        }
    }
    return distance;
}

}  // namespace

int edge_direction(double x, double y) {
    const double half_turns = std::atan2(y, x) / std::numbers::pi;  // -1..1
    const int direction = int(std::floor(half_turns * edge_directions));
    return (direction + edge_directions) % edge_directions;
}

ColorEdges color_edges(const Image<EncodedRgb>& color) {
    if (color.empty()) return {};
    ColorEdges result;
    result.gradient = strongest_gradient(color);
    cv::Mat1b edges = ridges(result.gradient);
    drop_short(edges);
    std::array<cv::Mat1b, edge_directions> elsewhere;
    for (cv::Mat1b& mask : elsewhere)
        mask = cv::Mat1b(edges.rows, edges.cols, std::uint8_t(255));
    for (int y = 0; y < edges.rows; ++y) {
        for (int x = 0; x < edges.cols; ++x) {
            if (edges(y, x) == 0) continue;
            const glm::vec2& g = result.gradient(x, y);
            const int own = edge_direction(double(g.x), double(g.y));
            for (const int turn : {edge_directions - 1, 0, 1})
                elsewhere[std::size_t((own + turn) % edge_directions)](y, x) = 0;
        }
    }
    for (std::size_t i = 0; i < elsewhere.size(); ++i)
        result.distance[i] = distance_from(elsewhere[i]);
    return result;
}

}  // namespace inlay
