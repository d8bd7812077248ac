// BareScene: triangles and spheres in one flat Embree scene, asked for hits alone: the limit that a
// tracer is measured by.
#pragma once

#include "render/trace/embree_scene.h"

#include <embree3/rtcore.h>

#include <vector>

namespace inlay {

/// Parts of scenes in world space, without instances and without the robust flag.
class BareScene {
public:
    explicit BareScene(const std::vector<const EmbreeScene*>& scenes,
                       RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);
    ~BareScene();
    BareScene(const BareScene&) = delete;
    BareScene& operator=(const BareScene&) = delete;

    RTCScene handle() const { return scene_; }

private:
    RTCDevice device_;
    RTCScene scene_;
};

/// Packets as Embree takes them, made ready beforehand.
struct BareRays {
    struct Packet {
        alignas(64) std::array<float, packet_width> origin_x, origin_y, origin_z, direction_x,
            direction_y, direction_z;
        alignas(64) std::array<int, packet_width> valid;
        float t_min;
        bool coherent, nearest;
    };
    std::vector<Packet> packets;
    std::uint64_t rays = 0;

    void add(const RayPacket& rays, bool nearest);
};

BareRays bare_rays(const RayLog& log);

/// What a packet meets first: no_hit and no normal where nothing.
struct BareHits {
    std::array<float, packet_width> distance;    // m
    std::array<glm::vec3, packet_width> normal;  // unit, world, towards the ray's origin
};
BareHits nearest_hits(const BareScene& scene, const BareRays::Packet& packet);

/// Asks for all hits on all threads. Returns how many rays met something.
std::uint64_t trace_bare(const BareScene& scene, const BareRays& rays);

}  // namespace inlay
