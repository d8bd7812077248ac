// EmbreeScene: triangles and spheres behind packets of 16 rays. The only file that calls Embree.
#pragma once

#include "render/scene/virtual_scene.h"
#include "render/trace/bounding_spheres.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace inlay {

inline constexpr int packet_width = 16;

/// Up to 16 rays; lanes whose bit in `active` is 0 are not traced. Directions are unit.
struct RayPacket {
    std::uint32_t active = 0;
    std::array<glm::vec3, packet_width> origin;     // m, world
    std::array<glm::vec3, packet_width> direction;  // unit, world
    float t_min = 0;                                // m
    bool coherent = false;                          // primary rays: neighbours go the same way

    void set(int lane, const glm::vec3& o, const glm::vec3& d) {
        active |= 1U << lane;
        origin[std::size_t(lane)] = o;
        direction[std::size_t(lane)] = d;
    }
    bool has(int lane) const { return (active >> lane) & 1U; }
};

inline constexpr float no_hit = std::numeric_limits<float>::infinity();
inline constexpr std::uint32_t no_part = 0xffffffffU;

struct SurfaceHit {
    float distance = no_hit;       // m
    std::uint32_t part = no_part;  // index into EmbreeScene's parts
    std::uint32_t triangle = 0;    // of a mesh
    glm::vec2 barycentric{0.0f};   // weights of the triangle's second and third vertex
    bool hit() const { return part != no_part; }
};

using HitPacket = std::array<SurfaceHit, packet_width>;

/// What a scene was asked, in that order, for a bench to ask it of Embree alone. For one thread.
struct RayLog {
    struct Query {
        RayPacket rays;
        bool nearest;  // else any hit
    };
    std::vector<Query> queries;
};

/// What a hit is made of, in world space.
struct SurfacePoint {
    glm::vec3 position;          // m
    glm::vec3 geometric_normal;  // unit, of the triangle or sphere
    glm::vec3 shading_normal;    // unit, interpolated
    glm::vec2 uv{0.0f};          // texture coordinates
    Rgb vertex_color{0.0f};      // interpolated; 0 without
};

/// A part placed in the world.
struct PlacedPart {
    std::shared_ptr<const TriangleMesh> mesh;  // null: a sphere of `radius` about the local origin
    float radius = 0;
    Material material;
    std::uint32_t object = 0;  // index of its object in the scene
    glm::mat4 world_from_local{1.0f};
    glm::mat3 world_from_local_normal{1.0f};
};

/// An acceleration structure over placed parts. Movable; queries are const and may run in parallel.
/// Instruction set and build are fixed, so that hits are the same bits on every machine.
class EmbreeScene {
public:
    EmbreeScene();
    ~EmbreeScene();
    EmbreeScene(EmbreeScene&&) noexcept;
    EmbreeScene& operator=(EmbreeScene&&) noexcept;

    const std::vector<PlacedPart>& parts() const { return parts_; }
    /// Spheres that hold all parts (m, world); none for a scene placed from one mesh.
    const std::vector<BoundingSphere>& bounds() const { return bounds_; }

    HitPacket intersect(const RayPacket& rays) const;     // nearest hits
    std::uint32_t occluded(const RayPacket& rays) const;  // bit mask of lanes that hit anything

    SurfacePoint surface_point(const SurfaceHit& hit, const glm::vec3& origin,
                               const glm::vec3& direction) const;
    Rgb vertex_color(const SurfaceHit& hit) const;  // of surface_point() there, for itself

    /// Writes down all that is asked from now on; null: no more.
    void log_to(RayLog* log) { log_ = log; }

private:
    friend class EmbreeSceneCache;
    struct Handles;
    std::unique_ptr<Handles> handles_;
    std::vector<PlacedPart> parts_;
    std::vector<BoundingSphere> bounds_;
    RayLog* log_ = nullptr;
};

/// Keeps the acceleration structure of each mesh, so that a frame only places them anew.
class EmbreeSceneCache {
public:
    EmbreeSceneCache();
    ~EmbreeSceneCache();
    EmbreeSceneCache(EmbreeSceneCache&&) noexcept;

    /// The objects (all, or only those whose `real` flag equals `*real`) as they stand at `time`
    /// (s).
    EmbreeScene place(const VirtualScene& scene, double time, std::optional<bool> real = {});
    /// One mesh, in world coordinates.
    EmbreeScene place(std::shared_ptr<const TriangleMesh> mesh);

private:
    struct Structures;
    std::unique_ptr<Structures> structures_;
    EmbreeScene build(std::vector<PlacedPart> parts);
};

}  // namespace inlay
