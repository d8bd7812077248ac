// The distance field between the voxels: trilinear distance, gradient and color.
#pragma once

#include "recordings/base/color.h"
#include "slam/volume/voxel_volume.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>

namespace inlay {

/// Where a voxel is stored; nowhere where nothing is allocated.
struct VoxelPlace {
    const Brick* brick = nullptr;
    std::size_t slot = 0;

    float distance() const { return brick ? brick->distance[slot] : unknown_distance; }
    float weight() const { return brick ? brick->weight[slot] : 0; }
};

/// Reads a volume at many nearby points: it remembers the bricks that it read last. Points are in
/// voxel units: p_world / voxel_size.
class VolumeSampler {
public:
    explicit VolumeSampler(const VoxelVolume& volume) : volume_(&volume) {}

    /// Distance (of the truncation, -1..1); unknown_distance where one of the eight voxels around
    /// the point was never seen.
    float distance(const glm::vec3& p);
    /// Gradient of the distance per voxel, over two voxels, or one at the border of what was seen;
    /// 0 where it is not known.
    glm::vec3 gradient(const glm::vec3& p);
    /// The voxel at a lattice position.
    VoxelPlace voxel(const glm::ivec3& v);

private:
    struct Known {
        glm::ivec3 key{0};
        const Brick* brick = nullptr;
        bool read = false;
    };
    const Brick* brick(const glm::ivec3& key);

    const VoxelVolume* volume_;
    std::array<Known, 8> known_;  // by the parity of the key: bricks that meet have places apart
};

/// VolumeSampler::gradient() of the field that `distance` gives.
template <class Distance>
glm::vec3 field_gradient(const Distance& distance, const glm::vec3& p) {
    const float here = distance(p);
    glm::vec3 result(0);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 offset(0);
        offset[axis] = 1;
        const float ahead = distance(p + offset), behind = distance(p - offset);
        const bool both = is_known(ahead) && is_known(behind);
        if (!both && (!is_known(here) || is_known(ahead) == is_known(behind))) return glm::vec3(0);
        if (both) {
            result[axis] = (ahead - behind) / 2;
        } else {
            result[axis] = is_known(ahead) ? ahead - here : here - behind;
        }
    }
    return result;
}

/// The fused linear color at a point (m, world): trilinear over those of the eight voxels around it
/// that saw a color; empty where none did.
std::optional<Rgb> volume_color(const VoxelVolume& volume, const glm::vec3& p_world);
std::optional<Rgb> volume_color(VolumeSampler& sampler, const glm::vec3& p_voxels);
/// The same from the eight voxels, x fastest; `share` is how far the point lies beyond the first.
std::optional<Rgb> mixed_color(const std::array<VoxelPlace, 8>& voxels, const glm::vec3& share);

}  // namespace inlay
