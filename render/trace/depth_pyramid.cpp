// Builds the pyramid in inverse depth, rounding every range outwards.
#include "render/trace/depth_pyramid.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace inlay {
namespace {

/// Surfaces seen at a flatter angle count as this steep when thickness turns into depth: else the
/// rims of round things, which are thin there, would throw walls behind them.
constexpr float smallest_cosine = 0.5f;

/// 16 float roundings: what the tracer computes in a pixel stays within the stored range.
constexpr float outwards = 16 * std::numeric_limits<float>::epsilon();

constexpr InverseDepthRange nothing{0.0f, std::numeric_limits<float>::max()};

InverseDepthRange join(const InverseDepthRange& a, const InverseDepthRange& b) {
    return {std::max(a.nearest, b.nearest), std::min(a.farthest, b.farthest)};
}

bool finite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The plane n . x = n . p in the image: 1/z = n . r / (n . p) for the ray r with z = 1.
PixelFacet facet_of(const glm::vec3& p, const glm::vec3& n, const Lens& lens,
                    const ScreenTracerSettings& settings) {
    constexpr float nearest = 1e-6f, farthest = 1e6f;  // m; products stay within float
    if (!finite(p) || p.z < nearest || p.z > farthest) return {};
    PixelFacet facet;
    facet.inverse_depth = 1 / p.z;
    const bool known = finite(n) && glm::dot(n, p) < 0;
    const float distance = glm::length(p);
    const float to_plane = known ? -glm::dot(n, p) : distance;
    if (known) {
        const float k = std::max(to_plane, 1e-6f * distance);
        const glm::vec2 gradient{-n.x / (float(lens.fx) * k), -n.y / (float(lens.fy) * k)};
        const float rise = (std::abs(gradient.x) + std::abs(gradient.y)) / 2;
        const float limit = settings.largest_tilt * facet.inverse_depth;
        const float kept = rise > limit ? limit / rise : 1.0f;
        facet.per_x = kept * gradient.x;
        facet.per_y = kept * gradient.y;
    }
    const float thickness = settings.thickness + settings.thickness_per_depth * p.z;
    facet.back = 1 / (1 + thickness / std::max(to_plane, smallest_cosine * distance));
    return facet;
}

InverseDepthRange range_of(const PixelFacet& facet) {
    if (facet.inverse_depth == 0) return nothing;
    const float rise = (std::abs(facet.per_x) + std::abs(facet.per_y)) / 2;
    return {(facet.inverse_depth + rise) * (1 + outwards),
            (facet.inverse_depth - rise) * facet.back * (1 - outwards)};
}

template <class Fine, class RangeOf>
Image<InverseDepthRange> halved(const Image<Fine>& fine, const RangeOf& range) {
    Image<InverseDepthRange> coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
    parallel_rows(coarse.height, [&](int y) {
        for (int x = 0; x < coarse.width; ++x) {
            const int x1 = std::min(2 * x + 1, fine.width - 1);
            const int y1 = std::min(2 * y + 1, fine.height - 1);
            coarse(x, y) = join(join(range(fine(2 * x, 2 * y)), range(fine(x1, 2 * y))),
                                join(range(fine(2 * x, y1)), range(fine(x1, y1))));
        }
    });
    return coarse;
}

void check(const SurfaceMap& map) {
    require(!distorted(map.lens),
            "screen tracer: the surface map's lens is distorted, expected a pinhole; raycast the "
            "map with pinhole(lens)");
    const auto fits = [&](const Image<glm::vec3>& image) {
        return image.width == map.lens.width && image.height == map.lens.height && !image.empty();
    };
    require(fits(map.position) && fits(map.normal),
            "screen tracer: the surface map is " + std::to_string(map.position.width) + " x " +
                std::to_string(map.position.height) + " px, its lens says " +
                std::to_string(map.lens.width) + " x " + std::to_string(map.lens.height));
}

}  // namespace

void validate(const ScreenTracerSettings& s) {
    require(s.thickness >= 0 && s.thickness_per_depth >= 0 && s.offset >= 0,
            "geometry.screen.thickness, geometry.screen.thickness_per_depth and geometry.offset "
            "must not be negative",
            ExitCode::usage);
    require(s.largest_tilt >= 0 && s.largest_tilt <= 0.5f,
            "geometry.screen.largest_tilt must lie within 0..0.5", ExitCode::usage);
}

DepthPyramid make_depth_pyramid(const SurfaceMap& map, const ScreenTracerSettings& settings) {
    check(map);
    DepthPyramid pyramid{map.lens,
                         map.world_from_camera,
                         inverse(map.world_from_camera),
                         Image<PixelFacet>(map.lens.width, map.lens.height),
                         {},
                         nothing};
    parallel_rows(map.lens.height, [&](int y) {
        for (int x = 0; x < map.lens.width; ++x)
            pyramid.facets(x, y) =
                facet_of(map.position(x, y), map.normal(x, y), map.lens, settings);
    });
    pyramid.levels.push_back(halved(pyramid.facets, range_of));
    const auto same = [](const InverseDepthRange& range) { return range; };
    while (pyramid.levels.back().pixels.size() > 1)
        pyramid.levels.push_back(halved(pyramid.levels.back(), same));
    pyramid.everything = pyramid.levels.back()(0, 0);
    return pyramid;
}

}  // namespace inlay
