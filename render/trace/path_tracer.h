// The reference: unbiased path tracing of one exact scene under an environment, 16 paths at a time.
#pragma once

#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"
#include "render/trace/embree_scene.h"

#include <array>

namespace inlay {

/// A point may not shadow itself: rays start this far (m) off exact surfaces.
inline constexpr float surface_offset = 1e-4f;

struct PathSettings {
    int max_vertices = 16;        // surface vertices of a path; the energy beyond is lost
    int roulette_after = 4;       // vertices before paths may end by Russian roulette
    std::uint32_t dimension = 0;  // of the first random number
};

using SampleKeys = std::array<SampleKey, packet_width>;
using RadiancePacket = std::array<Rgb, packet_width>;

/// Radiance that arrives along each active ray from surfaces and the environment. Next-event
/// estimation and BSDF sampling, combined by the balance heuristic (Veach 1997, ch. 9).
RadiancePacket trace_paths(const EmbreeScene& scene, const EnvironmentSampler& environment,
                           const RayPacket& rays, const SampleKeys& keys,
                           const PathSettings& settings);

/// Where to start a ray that leaves a surface towards `direction`.
inline glm::vec3 ray_origin(const glm::vec3& position, const glm::vec3& geometric_normal,
                            const glm::vec3& direction, float offset) {
    return position +
           (glm::dot(geometric_normal, direction) < 0 ? -offset : offset) * geometric_normal;
}

}  // namespace inlay
