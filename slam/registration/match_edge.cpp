#include "slam/registration/match_edge.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace inlay {
namespace {

constexpr double border = 3;          // px
constexpr double reach = 3;           // sigma, of the search along the normal
constexpr int per_pixel = 2;          // samples
constexpr double widest_sigma = 5;    // px
constexpr double least_contrast = 3;  // of 255 per px across the rim; less is noise
constexpr double half_contrast = 8;   // at which an edge counts half
constexpr std::size_t most_samples = 2 * std::size_t(reach * widest_sigma) * per_pixel + 1;

bool inside(const Image<glm::vec2>& image, const glm::dvec2& p, double margin) {
    return p.x > margin && p.y > margin && p.x < image.width - 1 - margin &&
           p.y < image.height - 1 - margin;
}

/// The distance between pixels, bilinear, and its slope.
std::optional<EdgeMatch> nearest_edge(const ColorEdges& edges, const SeenRim& rim) {
    const glm::dvec2& p = rim.position;
    if (!inside(edges.gradient, p, border)) return std::nullopt;
    const auto direction = std::size_t(edge_direction(rim.normal.x, rim.normal.y));
    const Image<std::uint8_t>& distance = edges.distance[direction];
    const int i = int(p.x), j = int(p.y);
    const double a = p.x - i, b = p.y - j;
    const auto at = [&](int x, int y) { return distance(x, y) / edge_distance_steps; };
    const double d00 = at(i, j), d10 = at(i + 1, j), d01 = at(i, j + 1), d11 = at(i + 1, j + 1);
    return EdgeMatch{
        (d00 * (1 - a) + d10 * a) * (1 - b) + (d01 * (1 - a) + d11 * a) * b,
        {(d10 - d00) * (1 - b) + (d11 - d01) * b, (d01 - d00) * (1 - a) + (d11 - d10) * a}};
}

/// Change of color across the normal, of 255 per px, bilinear.
double contrast(const Image<glm::vec2>& gradient, const glm::dvec2& p, const glm::dvec2& normal) {
    const int i = int(p.x), j = int(p.y);
    const float a = float(p.x - i), b = float(p.y - j);
    const glm::vec2* upper = &gradient(i, j);
    const glm::vec2* lower = upper + gradient.width;
    const glm::vec2 g =
        (upper[0] * (1 - a) + upper[1] * a) * (1 - b) + (lower[0] * (1 - a) + lower[1] * a) * b;
    return std::abs(double(g.x) * normal.x + double(g.y) * normal.y);
}

/// Where the parabola through three samples, 1 px apart, has its maximum: px from the middle one.
/// Bilinear sampling may make the top flat, but no wider than that.
double peak(double before, double middle, double after) {
    const double curvature = before - 2 * middle + after;
    if (!(curvature < -1e-6)) return 0;
    return std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5);
}

/// The local maximum of contrast that is strong and close.
std::optional<EdgeMatch> crossed_edge(const ColorEdges& edges, const SeenRim& rim, double sigma) {
    assert(sigma <= widest_sigma);
    const int half = int(reach * sigma) * per_pixel;
    if (!inside(edges.gradient, rim.position, reach * sigma + 2)) return std::nullopt;
    std::array<double, most_samples> samples{};
    double* const middle = samples.data() + half;
    for (int k = -half; k <= half; ++k) {
        middle[k] =
            contrast(edges.gradient, rim.position + k / double(per_pixel) * rim.normal, rim.normal);
    }
    double best_score = 0, best_offset = 0;
    for (int k = per_pixel - half; k <= half - per_pixel; ++k) {
        const double* c = middle + k;
        if (!(c[0] >= c[-1] && c[0] > c[1] && c[0] > least_contrast)) continue;
        const double away = k / double(per_pixel) / sigma;
        const double score = c[0] / (c[0] + half_contrast) * std::exp(-0.5 * away * away);
        if (score <= best_score) continue;
        best_score = score;
        best_offset = k / double(per_pixel) + peak(c[-per_pixel], c[0], c[per_pixel]);
    }
    if (best_score == 0) return std::nullopt;
    return EdgeMatch{-best_offset, rim.normal};
}

}  // namespace

std::optional<EdgeMatch> match_edge(const ColorEdges& edges, const SeenRim& rim,
                                    const EdgeMatching& matching) {
    if (!rim.ahead) return std::nullopt;
    return matching.choice == EdgeChoice::nearest ? nearest_edge(edges, rim)
                                                  : crossed_edge(edges, rim, matching.sigma);
}

}  // namespace inlay
