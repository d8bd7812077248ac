// The distance field between the voxels: trilinear distance, gradient, weight and color.
#pragma once

#include "slam/volume/voxel_volume.h"

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

/// Reads a volume at many nearby points: it remembers the brick that it read last.
class VolumeSampler {
public:
    explicit VolumeSampler(const VoxelVolume& volume) : volume_(&volume) {}

    /// Distance (of the truncation, -1..1) at a point in voxel units; NaN where one of the eight
    /// voxels around it was never seen.
    float distance(const glm::vec3& p_voxels);
    /// Gradient of the distance per voxel; 0 where it is not known.
    glm::vec3 gradient(const glm::vec3& p_voxels);
    /// The voxel at a lattice position, or null.
    const Voxel* voxel(const glm::ivec3& v);
    /// The brick at `key`, or null.
    const Brick* brick(const glm::ivec3& key);

private:
    const VoxelVolume* volume_;
    glm::ivec3 last_key_{0};
    const Brick* last_ = nullptr;
    bool read_ = false;
};

/// The fused linear color at a point (m, world): trilinear over those of the eight voxels around it
/// that saw a color; empty where none did.
std::optional<Rgb> volume_color(const VoxelVolume& volume, const glm::vec3& p_world);

}  // namespace inlay
