#include "slam/edges/two_sides.h"

#include "recordings/base/parallel.h"
#include "slam/edges/edge_band.h"

#include <algorithm>
#include <bitset>
#include <cmath>

namespace inlay {
namespace {

constexpr int unknown_class = 255;
constexpr int last_class = 250;   // of depth that is known
constexpr float nearest = 0.25f;  // m, of the second class
constexpr float ratio = 1.0125f;  // of depth, from class to class: up to 5.6 m
constexpr int gap = 2;            // classes, at least, that are empty between two surfaces
constexpr int tile = 4;           // px

int class_of(float z) {
    if (!(z > 0)) return unknown_class;
    const float place = 1 + std::log(z / nearest) / std::log(ratio);
    return int(std::clamp(place, 0.0f, float(last_class)));
}

void add(EdgeSide& side, std::size_t pixel, int distance2) {
    if (side.count == EdgeSide::most) return;
    side.pixel[std::size_t(side.count)] = pixel;
    side.distance2[std::size_t(side.count)] = float(distance2);
    ++side.count;
}

}  // namespace

std::vector<SideFinder::Step> SideFinder::steps_within(int reach, int stride) {
    std::vector<Step> steps;
    for (int y = -reach; y <= reach; y += stride)
        for (int x = -reach; x <= reach; x += stride)
            steps.push_back({{x, y}, x * x + y * y});
    std::stable_sort(steps.begin(), steps.end(),
                     [](const Step& a, const Step& b) { return a.distance2 < b.distance2; });
    return steps;
}

SideFinder::SideFinder(const SurfaceMap& map, const Image<std::uint8_t>& band)
    : band_(band),
      depth_class_(band.width, band.height),
      runs_((band.width + tile - 1) / tile, (band.height + tile - 1) / tile),
      window_(steps_within(window, 1)),
      sparse_(steps_within(window, 2)),
      near_(steps_within(widest_band + 1, 1)) {
    parallel_rows(band.height, [&](int y) {
        for (int x = 0; x < band.width; ++x)
            depth_class_(x, y) = std::uint8_t(class_of(map.position(x, y).z));
    });
    parallel_rows(runs_.height, [&](int y) {
        for (int x = 0; x < runs_.width; ++x)
            if (asked(x, y)) runs_(x, y) = runs_around(tile * x + tile / 2, tile * y + tile / 2);
    });
}

/// Whether a tile has a pixel of the band.
bool SideFinder::asked(int x, int y) const {
    for (int j = tile * y; j < std::min(tile * (y + 1), band_.height); ++j)
        for (int i = tile * x; i < std::min(tile * (x + 1), band_.width); ++i)
            if (band_(i, j) != 0) return true;
    return false;
}

/// The surfaces that trusted pixels around show. More than fit are taken for the last one.
SideFinder::Runs SideFinder::runs_around(int x, int y) const {
    std::bitset<unknown_class + 1> seen;
    for (const Step& step : window_) {
        const int i = x + step.by.x, j = y + step.by.y;
        if (band_.contains(i, j) && band_(i, j) == 0) seen.set(depth_class_(i, j));
    }
    Runs runs;
    std::size_t count = 0;
    int before = -1;
    for (int c = 0; c <= unknown_class; ++c) {
        if (!seen[std::size_t(c)]) continue;
        const bool apart = before < 0 || c - before > gap;
        if (apart && count < most_runs) runs[count++].first = std::uint8_t(c);
        runs[count - 1].last = std::uint8_t(c);
        before = c;
    }
    return runs;
}

float SideFinder::from_edge(int x, int y, const Run& own) const {
    const int farthest = band_(x, y) + 1;
    for (const Step& step : near_) {
        if (step.distance2 >= farthest * farthest) break;
        const int i = x + step.by.x, j = y + step.by.y;
        if (band_.contains(i, j) && !own.holds(depth_class_(i, j)))
            return std::sqrt(float(step.distance2));
    }
    return float(farthest);
}

TwoSides SideFinder::around(int x, int y) const {
    const Runs& runs = runs_(x / tile, y / tile);
    const auto run_of = [&](int depth_class, int slack) {
        const auto run = std::find_if(runs.begin(), runs.end(), [&](const Run& r) {
            return r.first <= r.last && depth_class >= r.first - slack &&
                   depth_class <= r.last + slack;
        });
        return int(run - runs.begin());
    };
    const int none = int(most_runs);
    const bool measured = depth_class_(x, y) != unknown_class;
    TwoSides sides;
    int own = measured ? run_of(depth_class_(x, y), gap) : none, other = none;
    if (measured && own == none) return sides;
    EdgeSide of_own, of_other;
    for (const Step& step : sparse_) {
        const int i = x + step.by.x, j = y + step.by.y;
        if (!band_.contains(i, j) || band_(i, j) != 0) continue;
        const int run = run_of(depth_class_(i, j), 0);
        if (run == none) continue;
        if (own == none) own = run;
        if (run != own && other == none) other = run;
        if (run == own) add(of_own, band_.index(i, j), step.distance2);
        if (run == other) add(of_other, band_.index(i, j), step.distance2);
    }
    if (of_own.count == 0) return sides;
    const bool own_is_near = other == none || own < other;
    sides.near = own_is_near ? of_own : of_other;
    sides.far = own_is_near ? of_other : of_own;
    if (!measured) return sides;
    sides.own = own_is_near ? OwnSide::near : OwnSide::far;
    Run around_own = runs[std::size_t(own)];
    around_own.first = std::uint8_t(std::max(0, around_own.first - gap));
    around_own.last = std::uint8_t(std::min(last_class, around_own.last + gap));
    sides.from_edge = from_edge(x, y, around_own);
    return sides;
}

}  // namespace inlay
