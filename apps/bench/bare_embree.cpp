#include "apps/bench/bare_embree.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

void attach(RTCDevice device, RTCScene scene, const PlacedPart& part, RTCBuildQuality quality) {
    RTCGeometry geometry = nullptr;
    const glm::mat4& place = part.world_from_local;
    if (!part.mesh) {
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* sphere = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), 1));
        *sphere = glm::vec4(glm::vec3(place[3]), part.radius * glm::length(glm::vec3(place[0])));
    } else {
        const TriangleMesh& mesh = *part.mesh;
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<glm::vec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(glm::vec3), mesh.positions.size()));
        auto* indices = static_cast<glm::uvec3*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(glm::uvec3), mesh.triangles.size()));
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            vertices[i] = glm::vec3(place * glm::vec4(mesh.positions[i], 1));
        std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    }
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

void fill(RTCRay16& ray, const BareRays::Packet& packet) {
    std::copy(packet.origin_x.begin(), packet.origin_x.end(), ray.org_x);
    std::copy(packet.origin_y.begin(), packet.origin_y.end(), ray.org_y);
    std::copy(packet.origin_z.begin(), packet.origin_z.end(), ray.org_z);
    std::copy(packet.direction_x.begin(), packet.direction_x.end(), ray.dir_x);
    std::copy(packet.direction_y.begin(), packet.direction_y.end(), ray.dir_y);
    std::copy(packet.direction_z.begin(), packet.direction_z.end(), ray.dir_z);
    std::fill_n(ray.tnear, packet_width, packet.t_min);
    std::fill_n(ray.tfar, packet_width, no_hit);
    std::fill_n(ray.time, packet_width, 0.0f);
    std::fill_n(ray.mask, packet_width, 0xffffffffU);
    std::fill_n(ray.flags, packet_width, 0U);
}

RTCRayHit16 ask_nearest(RTCScene scene, const BareRays::Packet& packet) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (packet.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    RTCRayHit16 query;
    fill(query.ray, packet);
    std::fill_n(query.hit.geomID, packet_width, RTC_INVALID_GEOMETRY_ID);
    rtcIntersect16(packet.valid.data(), scene, &context, &query);
    return query;
}

int trace(RTCScene scene, const BareRays::Packet& packet) {
    int met = 0;
    if (packet.nearest) {
        const RTCRayHit16 found = ask_nearest(scene, packet);
        for (const unsigned id : found.hit.geomID)
            met += id != RTC_INVALID_GEOMETRY_ID;
    } else {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay16 query;
        fill(query, packet);
        rtcOccluded16(packet.valid.data(), scene, &context, &query);
        for (const float end : query.tfar)
            met += end < 0;
    }
    return met;
}

}  // namespace

BareScene::BareScene(const std::vector<const EmbreeScene*>& scenes, RTCBuildQuality quality)
    : device_(rtcNewDevice("isa=avx2")), scene_(rtcNewScene(device_)) {
    rtcSetSceneBuildQuality(scene_, quality);
    for (const EmbreeScene* scene : scenes)
        for (const PlacedPart& part : scene->parts())
            attach(device_, scene_, part, quality);
    rtcCommitScene(scene_);
}

BareScene::~BareScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
}

void BareRays::add(const RayPacket& from, bool nearest) {
    if (from.active == 0) return;
    Packet packet{};
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        packet.valid[i] = from.has(lane) ? -1 : 0;
        packet.direction_z[i] = 1;
        if (!from.has(lane)) continue;
        packet.origin_x[i] = from.origin[i].x, packet.origin_y[i] = from.origin[i].y,
        packet.origin_z[i] = from.origin[i].z;
        packet.direction_x[i] = from.direction[i].x, packet.direction_y[i] = from.direction[i].y,
        packet.direction_z[i] = from.direction[i].z;
    }
    packet.t_min = from.t_min;
    packet.coherent = from.coherent;
    packet.nearest = nearest;
    packets.push_back(packet);
    rays += std::uint64_t(std::popcount(from.active));
}

BareRays bare_rays(const RayLog& log) {
    BareRays result;
    result.packets.reserve(log.queries.size());
    for (const RayLog::Query& query : log.queries)
        result.add(query.rays, query.nearest);
    return result;
}

BareHits nearest_hits(const BareScene& scene, const BareRays::Packet& packet) {
    const RTCRayHit16 found = ask_nearest(scene.handle(), packet);
    BareHits hits;
    for (std::size_t i = 0; i < packet_width; ++i) {
        hits.distance[i] = no_hit;
        if (!packet.valid[i] || found.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        hits.distance[i] = found.ray.tfar[i];
        const glm::vec3 n =
            glm::normalize(glm::vec3(found.hit.Ng_x[i], found.hit.Ng_y[i], found.hit.Ng_z[i]));
        const glm::vec3 d(packet.direction_x[i], packet.direction_y[i], packet.direction_z[i]);
        hits.normal[i] = glm::dot(n, d) > 0 ? -n : n;
    }
    return hits;
}

std::uint64_t trace_bare(const BareScene& scene, const BareRays& rays) {
    constexpr int block = 1024;
    const int count = int(rays.packets.size()), blocks = (count + block - 1) / block;
    return std::uint64_t(ordered_sum(blocks, [&](int b) {
        int met = 0;
        for (int i = b * block; i < std::min(count, (b + 1) * block); ++i)
            met += trace(scene.handle(), rays.packets[std::size_t(i)]);
        return double(met);
    }));
}

}  // namespace inlay
