#include "slam/volume/raycast_volume.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/ray_ranges.h"
#include "slam/volume/sample_volume.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace inlay {
namespace {

constexpr float surely_far = 0.7f;  // of the truncation; nearer, the field is read trilinearly
constexpr float caution = 0.8f;     // share of the distance that a ray advances

/// A ray in voxel units, by z in metres.
struct VoxelRay {
    glm::vec3 eye, direction;  // voxels, voxels per metre of z
    float truncation;          // m of z that the ray needs for one truncation
    glm::vec3 at(float z) const { return eye + z * direction; }
};

/// z at which the ray leaves the cells of the brick that holds `p`, and a little more.
float z_beyond_brick(const VoxelRay& ray, const glm::vec3& p, const glm::ivec3& key, float z) {
    float ahead = std::numeric_limits<float>::max();
    for (int i = 0; i < 3; ++i) {
        if (ray.direction[i] == 0) continue;
        const float wall = float(key[i] * brick_side) + (ray.direction[i] > 0 ? 7.5f : -0.5f);
        ahead = std::min(ahead, (wall - p[i]) / ray.direction[i]);
    }
    return z + std::max(ahead, 0.0f) + 0.02f / glm::length(ray.direction);
}

/// Sharpens a zero crossing between z0 (distance d0 > 0) and z1 (distance d1 <= 0).
float crossing(VolumeSampler& sampler, const VoxelRay& ray, float z0, float d0, float z1,
               float d1) {
    float z = z0 + (z1 - z0) * d0 / (d0 - d1);
    for (int i = 0; i < 2; ++i) {
        const float d = sampler.distance(ray.at(z));
        if (!is_known(d) || d == 0) break;
        (d > 0 ? z0 : z1) = z;
        (d > 0 ? d0 : d1) = d;
        z = z0 + (z1 - z0) * d0 / (d0 - d1);
    }
    return z;
}

/// z of the first passage from the free side to the other; empty if there is none in the range.
std::optional<float> first_crossing(VolumeSampler& sampler, const VoxelRay& ray,
                                    const ZRange& range) {
    const float half_voxel = 0.5f / glm::length(ray.direction);
    float z = range.nearest, z_free = 0, d_free = -1;  // the last point known to be free
    while (z <= range.farthest) {
        const glm::vec3 p = ray.at(z);
        const glm::ivec3 nearest(glm::floor(p + 0.5f));
        const glm::ivec3 key = brick_of(nearest);
        const Brick* brick = sampler.brick(key);
        if (!brick) {
            d_free = -1;
            z = z_beyond_brick(ray, p, key, z);
            continue;
        }
        const Voxel& voxel = brick->voxels[std::size_t(slot_in_brick(nearest))];
        float d = voxel.weight > 0 ? voxel.distance : unknown_distance;
        if (std::abs(d) < surely_far) d = sampler.distance(p);
        if (d <= 0 && d_free > 0) return crossing(sampler, ray, z_free, d_free, z, d);
        const bool free = d > 0 && is_known(d);
        d_free = free ? d : -1;
        z_free = z;
        z += free ? std::max(half_voxel, caution * d * ray.truncation) : half_voxel;
    }
    return std::nullopt;
}

void see(SurfaceMap& map, int x, int y, VolumeSampler& sampler, const VoxelRay& ray, float z,
         const glm::vec3& ray_camera, const RaycastSettings& settings) {
    const glm::vec3 p = ray.at(z);
    const Voxel* voxel = sampler.voxel(glm::ivec3(glm::floor(p + 0.5f)));
    if (!voxel || voxel->weight <= settings.least_weight) return;
    const glm::vec3 gradient = sampler.gradient(p);
    const float steepness = glm::length(gradient);
    if (!(steepness > 0)) return;
    const glm::vec3 normal =
        glm::transpose(glm::mat3(map.world_from_camera.rotation)) * (gradient / steepness);
    if (glm::dot(normal, ray_camera) >= 0) return;
    map.position(x, y) = z * ray_camera;
    map.normal(x, y) = normal;
    map.confidence(x, y) = std::min(1.0f, voxel->weight / settings.full_confidence);
}

}  // namespace

void validate(const RaycastSettings& s) {
    require(s.nearest > 0 && s.nearest < s.farthest && std::isfinite(s.farthest),
            "slam.raycast.nearest must be above 0 and below slam.raycast.farthest",
            ExitCode::usage);
    require(s.least_weight >= 0 && s.full_confidence > 0,
            "slam.raycast.least_weight must be 0 or more and slam.raycast.full_confidence above 0",
            ExitCode::usage);
}

SurfaceMap raycast_volume(const VoxelVolume& volume, const Lens& lens,
                          const Pose& world_from_camera, const RaycastSettings& settings) {
    SurfaceMap map = empty_surface_map(lens, world_from_camera);
    const CameraView view = camera_view(lens);
    const RayRanges ranges = ray_ranges(volume, view, inverse(world_from_camera), settings.nearest);
    const glm::mat3 rotation(world_from_camera.rotation);
    const float voxels_per_metre = 1.0f / volume.voxel_size;
    const glm::vec3 eye = glm::vec3(world_from_camera.translation) * voxels_per_metre;
    parallel_rows(lens.height, [&](int y) {
        VolumeSampler sampler(volume);
        for (int x = 0; x < lens.width; ++x) {
            const glm::vec3& direction = (*view.rays)(x, y);
            ZRange range = ranges.of(direction);
            range.farthest = std::min(range.farthest, settings.farthest);
            const VoxelRay ray{eye, rotation * direction * voxels_per_metre,
                               volume.truncation / glm::length(direction)};
            const auto z = first_crossing(sampler, ray, range);
            if (z) see(map, x, y, sampler, ray, *z, direction, settings);
        }
    });
    return map;
}

}  // namespace inlay
