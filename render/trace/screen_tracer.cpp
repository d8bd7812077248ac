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

std::optional<Found> walk(const DepthPyramid& map, const ImageRay& seen) {
    const Axis x_axis(seen.start.x, seen.step.x), y_axis(seen.start.y, seen.step.y);
    const int top = int(map.levels.size());
    int x = nearest(seen.start.x, map.lens.width), y = nearest(seen.start.y, map.lens.height);
    bool skip = starts_inside(seen, map, {x, y});
    int level = 0;
    double s = 0;
    while (map.facets.contains(x, y)) {
        const int block_x = x >> level, block_y = y >> level;
        const double leaving_x = x_axis.leaving(block_x, level);
        const double leaving_y = y_axis.leaving(block_y, level);
        const double end = std::max(s, std::min({leaving_x, leaving_y, 1.0}));
        if (level > 0) {
            if (may_meet(map.levels[std::size_t(level - 1)](block_x, block_y), seen.inverse_z(s),
                         seen.inverse_z(end))) {
                --level;
                continue;
            }
        } else if (!skip && s < end) {  // a corner that is only touched is not crossed
            if (const auto at = meet(seen, map.facets(x, y), {x, y}, s, end))
                return Found{*at, {x, y}};
        }
        skip = false;
        if (end >= 1) break;
        const bool along_x = leaving_x <= leaving_y;
        y = along_x ? y_axis.reached(y, block_y, level, end, false) : y_axis.beyond(block_y, level);
        x = along_x ? x_axis.beyond(block_x, level) : x_axis.reached(x, block_x, level, end, true);
        s = end;
        const int up = level + 1;
        if (up <= top && ((x >> up) != (block_x >> 1) || (y >> up) != (block_y >> 1))) level = up;
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
