// The hierarchical walk: up a level where a block is free, down where it may not be.
#include "render/trace/screen_tracer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace inlay {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// One image axis of a ray. Crossings of pixel edges are a function of the edge alone, so that
/// every walk, whatever its step, agrees to the bit on where the ray changes pixels.
struct Axis {
    double start, inverse_step;
    double step;
    int toward;  // +1, -1, or 0: never changes pixel

    Axis(double from, double by) : start(from), inverse_step(0), step(by), toward(0) {
        constexpr double shortest = 1e-12;  // px; less is rounding
        if (std::abs(by) < shortest) return;
        inverse_step = 1 / by;
        toward = by > 0 ? 1 : -1;
    }

    /// s at the edge between pixels `edge` - 1 and `edge`.
    double crossing(int edge) const { return (edge - 0.5 - start) * inverse_step; }

    double leaving(int block, int level) const {
        if (toward == 0) return never;
        return crossing((toward > 0 ? block + 1 : block) << level);
    }

    /// The first pixel beyond a block.
    int beyond(int block, int level) const {
        return toward > 0 ? (block + 1) << level : (block << level) - 1;
    }

    /// The pixel within `block` that the ray, now in `pixel`, has reached at s, where edges crossed
    /// exactly at s count as crossed only if `ties`.
    int reached(int pixel, int block, int level, double s, bool ties) const {
        if (toward == 0) return pixel;
        const auto crossed = [&](int edge) {
            return ties ? crossing(edge) <= s : crossing(edge) < s;
        };
        const int guess = int(std::floor(start + s * step + 0.5));
        if (toward > 0) {
            const int last = ((block + 1) << level) - 1;
            int p = std::clamp(guess, pixel, last);
            while (p < last && crossed(p + 1))
                ++p;
            while (p > pixel && !crossed(p))
                --p;
            return p;
        }
        const int last = block << level;
        int p = std::clamp(guess, last, pixel);
        while (p > last && crossed(p))
            --p;
        while (p < pixel && !crossed(p + 1))
            ++p;
        return p;
    }
};

int nearest(double position, int size) {
    return std::clamp(int(std::floor(position + 0.5)), 0, size - 1);
}

ScreenHit hit_at(const CameraRay& ray, const ImageRay& seen, const glm::ivec2& pixel, double s) {
    const double t = seen.distance(s);
    return {ScreenStatus::hit, pixel, t, ray.origin + t * ray.direction};
}

/// Whether the ray starts within the slab of the pixel it starts in.
bool starts_inside(const ImageRay& seen, const DepthPyramid& map, const glm::ivec2& pixel) {
    return seen.from_origin && meet(seen, map.facets(pixel.x, pixel.y), pixel, 0, 0).has_value();
}

bool may_meet(const InverseDepthRange& block, double inverse_z0, double inverse_z1) {
    return std::min(inverse_z0, inverse_z1) <= double(block.nearest) &&
           std::max(inverse_z0, inverse_z1) >= double(block.farthest);
}

/// The first slab along the ray.
struct Found {
    double s;
    glm::ivec2 pixel;
};

/// Where a walk stands: at s, about to enter the block of 2^level px that holds pixel (x, y).
struct Place {
    int x, y, level;
    double s;
};

/// One level up for each that the step from `before` has entered a new block of, two at most: most
/// of a ray is free, but the surface it has just left is near.
int climb(const Place& before, const Place& after, int top) {
    int level = before.level;
    while (level < std::min(before.level + 2, top)) {
        const int up = level + 1;
        if ((after.x >> up) == (before.x >> up) && (after.y >> up) == (before.y >> up)) break;
        level = up;
    }
    return level;
}

/// The place behind the block, left at s = `end`; at a corner, x changes before y.
Place beyond(const Axis& x_axis, const Axis& y_axis, const Place& at, bool along_x, double end) {
    const int level = at.level, block_x = at.x >> level, block_y = at.y >> level;
    if (along_x) {
        const int y = level == 0 ? at.y : y_axis.reached(at.y, block_y, level, end, false);
        return {x_axis.beyond(block_x, level), y, level, end};
    }
    const int x = level == 0 ? at.x : x_axis.reached(at.x, block_x, level, end, true);
    return {x, y_axis.beyond(block_y, level), level, end};
}

std::optional<Found> walk(const DepthPyramid& map, const ImageRay& seen) {
    const Axis x_axis(seen.start.x, seen.step.x), y_axis(seen.start.y, seen.step.y);
    Place at{nearest(seen.start.x, map.lens.width), nearest(seen.start.y, map.lens.height), 0, 0};
    bool skip = starts_inside(seen, map, {at.x, at.y});
    while (map.facets.contains(at.x, at.y)) {
        const int block_x = at.x >> at.level, block_y = at.y >> at.level;
        const double leaving_x = x_axis.leaving(block_x, at.level);
        const double leaving_y = y_axis.leaving(block_y, at.level);
        const double end = std::max(at.s, std::min({leaving_x, leaving_y, 1.0}));
        if (at.level > 0) {
            const auto& ranges = map.levels[std::size_t(at.level - 1)];
            if (may_meet(ranges(block_x, block_y), seen.inverse_z(at.s), seen.inverse_z(end))) {
                --at.level;
                continue;
            }
        } else if (!skip && at.s < end) {  // a corner that is only touched is not crossed
            if (const auto s = meet(seen, map.facets(at.x, at.y), {at.x, at.y}, at.s, end))
                return Found{*s, {at.x, at.y}};
        }
        skip = false;
        if (end >= 1) break;
        const Place before = at;
        at = beyond(x_axis, y_axis, before, leaving_x <= leaving_y, end);
        at.level = climb(before, at, int(map.levels.size()));
    }
    return std::nullopt;
}

/// s between which the ray is in column or row `pixel`; empty (first >= second) if it never is.
std::pair<double, double> stay(const Axis& axis, int pixel, int size) {
    const int first = nearest(axis.start, size);
    if (pixel == first) return {0.0, std::min(1.0, axis.leaving(pixel, 0))};
    if (axis.toward == 0 || (pixel > first) != (axis.toward > 0)) return {0.0, 0.0};
    return {std::max(0.0, axis.crossing(axis.toward > 0 ? pixel : pixel + 1)),
            std::min(1.0, axis.leaving(pixel, 0))};
}

std::optional<Found> search(const DepthPyramid& map, const ImageRay& seen) {
    const Axis x_axis(seen.start.x, seen.step.x), y_axis(seen.start.y, seen.step.y);
    const glm::ivec2 first_pixel{nearest(seen.start.x, map.lens.width),
                                 nearest(seen.start.y, map.lens.height)};
    const bool skip = starts_inside(seen, map, first_pixel);
    std::optional<Found> first;
    for (int y = 0; y < map.lens.height; ++y) {
        const auto [enter_row, leave_row] = stay(y_axis, y, map.lens.height);
        if (enter_row >= leave_row) continue;
        const double x0 = seen.position(enter_row).x, x1 = seen.position(leave_row).x;
        const int from = nearest(std::min(x0, x1) - 1, map.lens.width);  // 1 px: rounding
        const int to = nearest(std::max(x0, x1) + 1, map.lens.width);
        for (int x = from; x <= to; ++x) {
            const auto [enter, leave] = stay(x_axis, x, map.lens.width);
            const double s0 = std::max(enter, enter_row), s1 = std::min(leave, leave_row);
            if (s0 >= s1 || (skip && glm::ivec2(x, y) == first_pixel)) continue;
            const auto at = meet(seen, map.facets(x, y), {x, y}, s0, s1);
            if (at && (!first || *at < first->s)) first = Found{*at, {x, y}};
        }
    }
    return first;
}

template <class Find>
ScreenHit trace(const DepthPyramid& map, const CameraRay& ray, const Find& find) {
    const ClippedRay clipped = clip_to_image(ray, map.lens, map.everything);
    if (clipped.seen) {
        if (const std::optional<Found> found = find(map, *clipped.seen))
            return hit_at(ray, *clipped.seen, found->pixel, found->s);
    }
    ScreenHit none;
    none.status = clipped.leaves_image ? ScreenStatus::off_screen : ScreenStatus::missed;
    return none;
}

}  // namespace

ScreenHit trace_screen(const DepthPyramid& map, const CameraRay& ray) {
    return trace(map, ray, walk);
}

ScreenHit trace_screen_exhaustively(const DepthPyramid& map, const CameraRay& ray) {
    return trace(map, ray, search);
}

}  // namespace inlay
