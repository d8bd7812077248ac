#include "slam/edges/two_sides.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <bitset>
#include <cmath>

namespace inlay {
namespace {

constexpr int classes = 128;
constexpr int unknown_class = classes - 1;
constexpr float nearest = 0.25f;  // m, of the second class
constexpr float ratio = 1.025f;   // of depth, from class to class
constexpr int widest_band = 8;    // px
constexpr int tile = 4;           // px

int class_of(float z) {
    if (!(z > 0)) return unknown_class;
    const float place = 1 + std::log(z / nearest) / std::log(ratio);
    return int(std::clamp(place, 0.0f, float(unknown_class - 1)));
}

std::vector<NearbyPixel> pixels_within(int reach, int stride) {
    std::vector<NearbyPixel> pixels;
    for (int y = -reach; y <= reach; y += stride)
        for (int x = -reach; x <= reach; x += stride)
            pixels.push_back({{x, y}, x * x + y * y});
    std::stable_sort(pixels.begin(), pixels.end(), [](const NearbyPixel& a, const NearbyPixel& b) {
        return a.distance2 < b.distance2;
    });
    return pixels;
}

void add(EdgeSide& side, std::size_t pixel, int distance2) {
    if (side.count == EdgeSide::most) return;
    side.pixel[std::size_t(side.count)] = pixel;
    side.distance2[std::size_t(side.count)] = float(distance2);
    ++side.count;
}

}  // namespace

SideFinder::SideFinder(const SurfaceMap& map, const Image<std::uint8_t>& band)
    : band_(band),
      depth_class_(band.width, band.height),
      sparse_(pixels_within(window, 2)),
      dense_(pixels_within(widest_band + 1, 1)) {
    parallel_rows(band.height, [&](int y) {
        for (int x = 0; x < band.width; ++x)
            depth_class_(x, y) = std::uint8_t(class_of(map.position(x, y).z));
    });
    parting_ = Image<std::uint8_t>((band.width + tile - 1) / tile, (band.height + tile - 1) / tile);
    parallel_rows(parting_.height, [&](int y) {
        for (int x = 0; x < parting_.width; ++x)
            parting_(x, y) = std::uint8_t(find_parting(tile * x + tile / 2, tile * y + tile / 2));
    });
}

/// Behind the widest gap among the trusted pixels around; 0 if there is none.
int SideFinder::find_parting(int x, int y) const {
    std::bitset<classes> seen;
    for (const NearbyPixel& other : sparse_) {
        const int i = x + other.step.x, j = y + other.step.y;
        if (band_.contains(i, j) && band_(i, j) == 0) seen.set(depth_class_(i, j));
    }
    int before = -1, widest = 1, begin = 0;
    for (int c = 0; c < classes; ++c) {
        if (!seen[std::size_t(c)]) continue;
        if (before >= 0 && c - before > widest) widest = c - before, begin = c;
        before = c;
    }
    return begin;
}

float SideFinder::from_edge(int x, int y, int parting) const {
    const bool near = depth_class_(x, y) < parting;
    const int farthest = band_(x, y) + 1;
    for (const NearbyPixel& other : dense_) {
        if (other.distance2 >= farthest * farthest) break;
        const int i = x + other.step.x, j = y + other.step.y;
        if (band_.contains(i, j) && (depth_class_(i, j) < parting) != near)
            return std::sqrt(float(other.distance2));
    }
    return float(farthest);
}

TwoSides SideFinder::around(int x, int y) const {
    const int begin = parting_(x / tile, y / tile);
    TwoSides sides;
    for (const NearbyPixel& other : sparse_) {
        const int i = x + other.step.x, j = y + other.step.y;
        if (!band_.contains(i, j) || band_(i, j) != 0) continue;
        const bool far = begin > 0 && depth_class_(i, j) >= begin;
        add(far ? sides.far : sides.near, band_.index(i, j), other.distance2);
        if (sides.near.count == EdgeSide::most && (begin == 0 || sides.far.count == EdgeSide::most))
            break;
    }
    sides.in_near = depth_class_(x, y) < begin;
    if (begin > 0) sides.from_edge = from_edge(x, y, begin);
    return sides;
}

}  // namespace inlay
