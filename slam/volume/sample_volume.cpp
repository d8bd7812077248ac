#include "slam/volume/sample_volume.h"

namespace inlay {
namespace {

glm::ivec3 corner_offset(int corner) { return {corner & 1, (corner >> 1) & 1, corner >> 2}; }

float corner_weight(int corner, const glm::vec3& f) {
    return ((corner & 1) ? f.x : 1 - f.x) * ((corner & 2) ? f.y : 1 - f.y) *
           ((corner & 4) ? f.z : 1 - f.z);
}

}  // namespace

const Brick* VolumeSampler::brick(const glm::ivec3& key) {
    Known& known = known_[std::size_t((key.x & 1) | ((key.y & 1) << 1) | ((key.z & 1) << 2))];
    if (!known.read || known.key != key) known = {key, find_brick(*volume_, key), true};
    return known.brick;
}

VoxelPlace VolumeSampler::voxel(const glm::ivec3& v) {
    return {brick(brick_of(v)), std::size_t(slot_in_brick(v))};
}

float VolumeSampler::distance(const glm::vec3& p) {
    const glm::vec3 base = glm::floor(p);
    float sum = 0;
    for (int c = 0; c < 8; ++c) {
        const float d = voxel(glm::ivec3(base) + corner_offset(c)).distance();
        if (!is_known(d)) return unknown_distance;
        sum += corner_weight(c, p - base) * d;
    }
    return sum;
}

glm::vec3 VolumeSampler::gradient(const glm::vec3& p) {
    return field_gradient([this](const glm::vec3& q) { return distance(q); }, p);
}

std::optional<Rgb> mixed_color(const std::array<VoxelPlace, 8>& voxels, const glm::vec3& share) {
    Rgb sum(0);
    float weight = 0;
    for (int c = 0; c < 8; ++c) {
        const auto [brick, slot] = voxels[std::size_t(c)];
        if (!brick || brick->color_weight[slot] == 0) continue;
        const float w = corner_weight(c, share) + 1e-6f;  // so that one voxel is enough
        sum += w * Rgb(brick->color[0][slot], brick->color[1][slot], brick->color[2][slot]);
        weight += w;
    }
    if (weight == 0) return std::nullopt;
    return sum / (weight * 65535.0f);
}

std::optional<Rgb> volume_color(VolumeSampler& sampler, const glm::vec3& p_voxels) {
    const glm::vec3 base = glm::floor(p_voxels);
    std::array<VoxelPlace, 8> voxels;
    for (int c = 0; c < 8; ++c)
        voxels[std::size_t(c)] = sampler.voxel(glm::ivec3(base) + corner_offset(c));
    return mixed_color(voxels, p_voxels - base);
}

std::optional<Rgb> volume_color(const VoxelVolume& volume, const glm::vec3& p_world) {
    VolumeSampler sampler(volume);
    return volume_color(sampler, p_world / volume.voxel_size);
}

}  // namespace inlay
