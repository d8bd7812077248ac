// Landing: what a camera ray or an indirect ray met first, ready to receive light.
#pragma once

#include "render/scatter/bsdf.h"
#include "render/trace/embree_scene.h"
#include "render/trace/real_geometry.h"

namespace inlay {

enum class LandingKind { nothing, real, on_virtual };

struct Landing {
    LandingKind kind = LandingKind::nothing;
    float distance = 0;                              // m, along the ray
    glm::vec3 position{0.0f};                        // m, world
    glm::vec3 geometric_normal{0.0f}, normal{0.0f};  // unit, world, towards the ray's origin
    Bsdf bsdf;                                       // of virtual surfaces
    ScatterFrame frame;
    std::uint32_t object = 0;  // as in Receiver
};

using Landings = std::array<Landing, packet_width>;

/// `hit` must be one.
Landing land_on_virtual(const EmbreeScene& objects, const SurfaceHit& hit, const glm::vec3& origin,
                        const glm::vec3& direction);

/// Nearest of real and virtual surfaces for each camera ray. A real surface hides a virtual one
/// only if it is nearer by more than `depth_tolerance` (share of depth): measured depth is noisy.
Landings land(const RealGeometry& real, const EmbreeScene& objects, const RayPacket& camera_rays,
              const std::array<glm::ivec2, packet_width>& pixels, float depth_tolerance);

}  // namespace inlay
