#include "render/trace/embree_scene.h"

#include "recordings/base/check.h"
#include "render/trace/change_cones.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

namespace inlay {
namespace {

/// AVX2 on every machine: other instruction sets change the last bits of hits.
constexpr const char* device_settings = "isa=avx2";

constexpr int spheres_per_mesh = 16;
constexpr int spheres_per_scene = most_change_cones;

/// The square of a transform's largest stretch is an eigenvalue of its Gram matrix, at most the
/// largest sum of a row (Gershgorin).
BoundingSphere in_world(const BoundingSphere& sphere, const glm::mat4& world_from_local) {
    const glm::mat3 linear(world_from_local), gram = glm::transpose(linear) * linear;
    float square = 0;
    for (int row = 0; row < 3; ++row)
        square =
            std::max(square, std::abs(gram[row].x) + std::abs(gram[row].y) + std::abs(gram[row].z));
    constexpr float rounding_margin = 1 + 1e-5f;
    return {glm::vec3(world_from_local * glm::vec4(sphere.centre, 1)),
            sphere.radius * std::sqrt(square) * rounding_margin};
}

[[noreturn]] void refuse(const std::string& what) {
    throw Error(ExitCode::bad_data, "ray tracing (Embree): " + what);
}

RTCScene finished(RTCDevice device, RTCScene scene) {
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene);
    if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE)
        refuse("cannot build the scene, error " + std::to_string(int(error)));
    return scene;
}

RTCScene scene_of(RTCDevice device, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    RTCScene scene = rtcNewScene(device);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    return finished(device, scene);
}

RTCScene mesh_scene(RTCDevice device, const TriangleMesh& mesh) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(glm::vec3), mesh.positions.size()));
    auto* indices = static_cast<glm::uvec3*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(glm::uvec3), mesh.triangles.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), indices);
    return scene_of(device, geometry);
}

RTCScene sphere_scene(RTCDevice device, float radius) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    auto* centre = static_cast<glm::vec4*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof(glm::vec4), 1));
    *centre = glm::vec4(0, 0, 0, radius);
    return scene_of(device, geometry);
}

void fill(RTCRay16& ray, std::array<int, packet_width>& valid, const RayPacket& packet) {
    for (int i = 0; i < packet_width; ++i) {
        valid[std::size_t(i)] = packet.has(i) ? -1 : 0;
        const glm::vec3 o = packet.has(i) ? packet.origin[std::size_t(i)] : glm::vec3(0);
        const glm::vec3 d = packet.has(i) ? packet.direction[std::size_t(i)] : glm::vec3(0, 0, 1);
        ray.org_x[i] = o.x, ray.org_y[i] = o.y, ray.org_z[i] = o.z;
        ray.dir_x[i] = d.x, ray.dir_y[i] = d.y, ray.dir_z[i] = d.z;
        ray.tnear[i] = packet.t_min;
        ray.tfar[i] = no_hit;
        ray.time[i] = 0;
        ray.mask[i] = 0xffffffffU;
        ray.id[i] = unsigned(i);
        ray.flags[i] = 0;
    }
}

/// An attribute of a triangle's vertices, between them.
template <class Attribute>
Attribute between(const std::vector<Attribute>& of_vertices, const glm::uvec3& triangle,
                  const glm::vec2& barycentric) {
    const float b1 = barycentric.x, b2 = barycentric.y, b0 = 1 - b1 - b2;
    return b0 * of_vertices[triangle.x] + b1 * of_vertices[triangle.y] +
           b2 * of_vertices[triangle.z];
}

RTCIntersectContext context_for(const RayPacket& packet) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (packet.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

}  // namespace

struct EmbreeScene::Handles {
    RTCScene scene = nullptr;
    ~Handles() { rtcReleaseScene(scene); }
};

struct EmbreeSceneCache::Structures {
    RTCDevice device = rtcNewDevice(device_settings);
    std::map<std::shared_ptr<const TriangleMesh>, RTCScene> meshes;
    std::map<float, RTCScene> spheres;  // by radius
    std::map<std::shared_ptr<const TriangleMesh>, std::vector<BoundingSphere>> bounds;

    void release_meshes() {
        for (const auto& [mesh, scene] : meshes)
            rtcReleaseScene(scene);
        meshes.clear();
        bounds.clear();
    }

    ~Structures() {
        release_meshes();
        for (const auto& [radius, scene] : spheres)
            rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    /// In the part's own coordinates.
    std::vector<BoundingSphere> bounds_of(const PlacedPart& part) {
        if (!part.mesh) return {{glm::vec3(0), part.radius}};
        const auto [at, is_new] = bounds.try_emplace(part.mesh);
        if (is_new) at->second = enclosing_spheres(*part.mesh, spheres_per_mesh);
        return at->second;
    }

    RTCScene structure_of(const PlacedPart& part) {
        if (part.mesh) {
            RTCScene& scene = meshes[part.mesh];
            if (!scene) scene = mesh_scene(device, *part.mesh);
            return scene;
        }
        RTCScene& scene = spheres[part.radius];
        if (!scene) scene = sphere_scene(device, part.radius);
        return scene;
    }
};

EmbreeScene::EmbreeScene() = default;
EmbreeScene::~EmbreeScene() = default;
EmbreeScene::EmbreeScene(EmbreeScene&&) noexcept = default;
EmbreeScene& EmbreeScene::operator=(EmbreeScene&&) noexcept = default;

HitPacket EmbreeScene::intersect(const RayPacket& rays) const {
    HitPacket hits;
    if (log_) log_->queries.push_back({rays, true});
    if (!handles_ || rays.active == 0) return hits;
    alignas(64) std::array<int, packet_width> valid;
    alignas(64) RTCRayHit16 query;
    fill(query.ray, valid, rays);
    for (int i = 0; i < packet_width; ++i) {
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
    RTCIntersectContext context = context_for(rays);
    rtcIntersect16(valid.data(), handles_->scene, &context, &query);
    for (int i = 0; i < packet_width; ++i) {
        if (!rays.has(i) || query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
        hits[std::size_t(i)] = {query.ray.tfar[i],
                                query.hit.instID[0][i],
                                query.hit.primID[i],
                                {query.hit.u[i], query.hit.v[i]}};
    }
    return hits;
}

std::uint32_t EmbreeScene::occluded(const RayPacket& rays) const {
    if (log_) log_->queries.push_back({rays, false});
    if (!handles_ || rays.active == 0) return 0;
    alignas(64) std::array<int, packet_width> valid;
    alignas(64) RTCRay16 query;
    fill(query, valid, rays);
    RTCIntersectContext context = context_for(rays);
    rtcOccluded16(valid.data(), handles_->scene, &context, &query);
    std::uint32_t blocked = 0;
    for (int i = 0; i < packet_width; ++i)
        if (rays.has(i) && query.tfar[i] < 0) blocked |= 1U << i;
    return blocked;
}

SurfacePoint EmbreeScene::surface_point(const SurfaceHit& hit, const glm::vec3& origin,
                                        const glm::vec3& direction) const {
    const PlacedPart& part = parts_[hit.part];
    SurfacePoint point{};
    if (!part.mesh) {
        const glm::vec3 centre(part.world_from_local[3]);
        const float radius = part.radius * glm::length(glm::vec3(part.world_from_local[0]));
        const glm::vec3 outward = glm::normalize(origin + hit.distance * direction - centre);
        point.position = centre + radius * outward;  // back onto the sphere, whatever t's rounding
        point.geometric_normal = point.shading_normal = outward;
        return point;
    }
    const TriangleMesh& mesh = *part.mesh;
    const glm::uvec3 t = mesh.triangles[hit.triangle];
    const auto mix = [&](const auto& attribute) { return between(attribute, t, hit.barycentric); };
    point.position = glm::vec3(part.world_from_local * glm::vec4(mix(mesh.positions), 1));
    const glm::vec3 face = glm::cross(mesh.positions[t.y] - mesh.positions[t.x],
                                      mesh.positions[t.z] - mesh.positions[t.x]);
    point.geometric_normal = glm::normalize(part.world_from_local_normal * face);
    point.shading_normal = point.geometric_normal;
    if (!mesh.normals.empty()) {
        const glm::vec3 n = part.world_from_local_normal * mix(mesh.normals);
        if (glm::dot(n, n) > 0) point.shading_normal = glm::normalize(n);
    }
    if (!mesh.texture_coordinates.empty()) point.uv = mix(mesh.texture_coordinates);
    point.vertex_color = vertex_color(hit);
    return point;
}

Rgb EmbreeScene::vertex_color(const SurfaceHit& hit) const {
    const TriangleMesh* mesh = parts_[hit.part].mesh.get();
    if (!mesh || mesh->colors.empty()) return Rgb(0);
    return between(mesh->colors, mesh->triangles[hit.triangle], hit.barycentric);
}

EmbreeSceneCache::EmbreeSceneCache() : structures_(std::make_unique<Structures>()) {
    if (!structures_->device) refuse("no device: this program needs a processor with AVX2");
}
EmbreeSceneCache::~EmbreeSceneCache() = default;
EmbreeSceneCache::EmbreeSceneCache(EmbreeSceneCache&&) noexcept = default;

EmbreeScene EmbreeSceneCache::build(std::vector<PlacedPart> parts) {
    EmbreeScene result;
    result.parts_ = std::move(parts);
    if (result.parts_.empty()) return result;
    RTCDevice device = structures_->device;
    RTCScene scene = rtcNewScene(device);
    for (std::uint32_t i = 0; i < result.parts_.size(); ++i) {
        const PlacedPart& part = result.parts_[i];
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, structures_->structure_of(part));
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT4X4_COLUMN_MAJOR,
                                &part.world_from_local[0][0]);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(scene, instance, i);
        rtcReleaseGeometry(instance);
    }
    result.handles_ = std::make_unique<EmbreeScene::Handles>();
    result.handles_->scene = finished(device, scene);
    return result;
}

EmbreeScene EmbreeSceneCache::place(const VirtualScene& scene, double time,
                                    std::optional<bool> real) {
    std::vector<PlacedPart> parts;
    for (std::uint32_t o = 0; o < scene.objects.size(); ++o) {
        const SceneObject& object = scene.objects[o];
        if (real && object.real != *real) continue;
        const glm::dmat4 world_from_object = transform_at(object, time);
        for (const ObjectPart& part : object.parts) {
            PlacedPart placed;
            if (const auto* mesh = std::get_if<MeshShape>(&part.shape)) {
                placed.mesh = mesh->mesh;
            } else {
                placed.radius = std::get<SphereShape>(part.shape).radius;
            }
            placed.material = part.material;
            placed.object = o;
            placed.world_from_local = glm::mat4(world_from_object);
            placed.world_from_local_normal =
                glm::mat3(glm::transpose(glm::inverse(glm::dmat3(world_from_object))));
            parts.push_back(std::move(placed));
        }
    }
    EmbreeScene result = build(std::move(parts));
    for (const PlacedPart& part : result.parts_)
        for (const BoundingSphere& sphere : structures_->bounds_of(part))
            result.bounds_.push_back(in_world(sphere, part.world_from_local));
    result.bounds_ = enclosing_spheres(std::move(result.bounds_), spheres_per_scene);
    return result;
}

EmbreeScene EmbreeSceneCache::place(std::shared_ptr<const TriangleMesh> mesh) {
    if (mesh->triangles.empty()) return {};
    structures_->release_meshes();
    std::vector<PlacedPart> parts(1);
    parts[0].mesh = std::move(mesh);
    return build(std::move(parts));
}

}  // namespace inlay
