// RealGeometry: the real scene as the two-mode sampler asks for it, whatever represents it.
#pragma once

#include "recordings/base/surface_map.h"
#include "recordings/base/triangle_mesh.h"
#include "render/trace/path_tracer.h"

#include <array>
#include <functional>
#include <memory>

namespace inlay {

/// The real surface seen along camera rays; `distance` no_hit where none is known.
struct RealPrimaryHit {
    float distance = no_hit;   // m, along the ray
    glm::vec3 position{0.0f};  // m, world
    glm::vec3 normal{0.0f};    // unit, world, towards the camera
};

/// The same of sixteen rays. Where a pixel sees two surfaces (SplitPixels), `pixel` has the one
/// that fills more of it, on which its light is gathered, and `ray` the one that the ray itself
/// meets, which counts where a virtual surface stands between the two.
struct RealPrimaryHits {
    std::array<RealPrimaryHit, packet_width> pixel, ray;
    std::uint32_t split = 0;  // bit mask of lanes where `ray` has something to say
};

using DistancePacket = std::array<float, packet_width>;

struct RealHits {
    DistancePacket distance;  // m; no_hit: none
    RadiancePacket radiance;  // that the hit surface sends back along the ray, real light alone
};

/// Functions over packets of rays. `offset` (m): how far off a real surface rays start, since
/// primary surface and traced surface may differ by the model's noise.
struct RealGeometry {
    std::function<RealPrimaryHits(const RayPacket& camera_rays,
                                  const std::array<glm::ivec2, packet_width>& pixels)>
        primary;
    std::function<DistancePacket(const RayPacket&)> distances;
    std::function<std::uint32_t(const RayPacket&)> occluded;  // bit mask of lanes that hit anything
    std::function<RealHits(const RayPacket&, const SampleKeys&)> radiances;
    float offset = surface_offset;
};

/// No real geometry at all.
RealGeometry no_real_geometry();

/// Exact objects (those flagged real), lit by the environment: radiance by path tracing.
/// The references must outlive the result.
RealGeometry exact_real_geometry(const EmbreeScene& real_objects,
                                 const EnvironmentSampler& environment, std::uint32_t dimension);

/// What the photograph knows: linear radiance, seen from the surface map's camera.
struct PhotographedSurface {
    const SurfaceMap& surface;
    const Image<Rgb>& photo;  // linear, of the surface map's size
};

/// Primary hits from the surface map; other rays against `mesh` (world coordinates), where the
/// radiance of a hit is the photograph's if the photograph sees that point (within
/// `visibility_tolerance`, m), else the mesh's vertex color. References must outlive the result.
RealGeometry mesh_real_geometry(const PhotographedSurface& seen, const EmbreeScene& mesh,
                                float offset, float visibility_tolerance);

/// A mesh (world coordinates) that radiates its vertex colors wherever it is seen from, and that no
/// camera ray meets. The reference must outlive the result.
RealGeometry mesh_alone(const EmbreeScene& mesh, float offset);

/// The surface map's pixels as triangles in world coordinates, colored by the photograph; none
/// across holes or depth steps steeper than `max_step` (share of depth).
TriangleMesh triangulate(const PhotographedSurface& seen, float max_step);

}  // namespace inlay
