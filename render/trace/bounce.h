// A packet of rays from receivers against real and virtual geometry, and what it brings back.
#pragma once

#include "render/trace/sample_pass.h"

namespace inlay {

/// Rays from landings against each kind of geometry: each kind has its own distance to start at.
struct RayPair {
    RayPacket against_virtual, against_real;

    /// `real_offset` (m) is how far off a real surface rays against real geometry start.
    void set(int lane, const Landing& from, const glm::vec3& direction, float real_offset);
};

/// Radiance that comes back in both modes; 0 where the ray meets no surface.
struct Bounce {
    RadiancePacket real_only{}, with_virtual{};
    DistancePacket distance;  // m, of the nearest surface, real or virtual; no_hit: none
};

/// Real hits send back what the real geometry says; virtual ones are shaded with one environment
/// sample each, shadowed by real and virtual geometry.
Bounce bounce(SamplePass& pass, const RayPair& rays);

/// Radiance that virtual surfaces send back along the rays of `lanes` (a bit mask), which meet them
/// at `hits`: shaded with one environment sample each, shadowed by real and virtual geometry.
RadiancePacket shade_virtual_hits(SamplePass& pass, const RayPacket& rays, const HitPacket& hits,
                                  std::uint32_t lanes);

/// Number of rays in a packet.
std::uint64_t count(const RayPacket& rays);

}  // namespace inlay
