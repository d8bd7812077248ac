// Hands packets of world rays to the screen tracer, one ray at a time.
#include "render/trace/screen_real_geometry.h"

#include "recordings/base/check.h"
#include "render/trace/map_primary.h"
#include "render/trace/screen_tracer.h"

#include <array>
#include <utility>

namespace inlay {
namespace {

using ScreenHits = std::array<ScreenHit, packet_width>;

ScreenHits trace_packet(const DepthPyramid& map, const RayPacket& rays, ScreenRayCounts* counts) {
    ScreenHits hits;
    std::array<std::uint64_t, 3> sums{};
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!rays.has(lane)) continue;
        const auto i = std::size_t(lane);
        hits[i] = trace_screen(map, {map.camera_from_world * glm::dvec3(rays.origin[i]),
                                     map.camera_from_world.rotation * glm::dvec3(rays.direction[i]),
                                     double(rays.t_min)});
        ++sums[std::size_t(hits[i].status)];
    }
    if (counts) {
        counts->hit.fetch_add(sums[std::size_t(ScreenStatus::hit)], std::memory_order_relaxed);
        counts->missed.fetch_add(sums[std::size_t(ScreenStatus::missed)],
                                 std::memory_order_relaxed);
        counts->off_screen.fetch_add(sums[std::size_t(ScreenStatus::off_screen)],
                                     std::memory_order_relaxed);
    }
    return hits;
}

DistancePacket distances_of(const ScreenHits& hits) {
    DistancePacket result;
    for (std::size_t i = 0; i < packet_width; ++i)
        result[i] = hits[i].status == ScreenStatus::hit ? float(hits[i].distance) : no_hit;
    return result;
}

}  // namespace

RealGeometry screen_real_geometry(const PhotographedSurface& seen,
                                  std::shared_ptr<const DepthPyramid> map,
                                  const ScreenTracerSettings& settings,
                                  std::shared_ptr<ScreenRayCounts> counts) {
    validate(settings);
    require(same_size(seen.photo, map->facets) && same_size(seen.surface.position, map->facets),
            "screen tracer: photograph, surface map and pyramid differ in size");
    RealGeometry real;
    real.offset = settings.offset;
    real.primary = [&surface = seen.surface, tilt = settings.largest_tilt](const RayPacket& rays,
                                                                           const auto& pixels) {
        return map_primary(surface, rays, pixels, tilt);
    };
    real.distances = [map, counts](const RayPacket& rays) {
        return distances_of(trace_packet(*map, rays, counts.get()));
    };
    real.occluded = [map, counts](const RayPacket& rays) {
        const ScreenHits hits = trace_packet(*map, rays, counts.get());
        std::uint32_t blocked = 0;
        for (std::size_t i = 0; i < packet_width; ++i)
            if (hits[i].status == ScreenStatus::hit) blocked |= 1U << i;
        return blocked;
    };
    real.radiances = [&photo = seen.photo, map = std::move(map), counts](const RayPacket& rays,
                                                                         const SampleKeys&) {
        const ScreenHits hits = trace_packet(*map, rays, counts.get());
        RealHits result{distances_of(hits), {}};
        for (std::size_t i = 0; i < packet_width; ++i) {
            if (hits[i].status == ScreenStatus::hit)
                result.radiance[i] = photo(hits[i].pixel.x, hits[i].pixel.y);
        }
        return result;
    };
    return real;
}

}  // namespace inlay
