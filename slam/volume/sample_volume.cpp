#include "slam/volume/sample_volume.h"

#include <cmath>

namespace inlay {
namespace {

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

const Voxel* VolumeSampler::voxel(const glm::ivec3& v) {
    const Brick* found = brick(brick_of(v));
    return found ? &found->voxels[std::size_t(slot_in_brick(v))] : nullptr;
}

std::array<const Voxel*, 8> VolumeSampler::corners(const glm::ivec3& base) {
    std::array<const Voxel*, 8> result{};
    const glm::ivec3 inside = base & 7;
    if (inside.x < 7 && inside.y < 7 && inside.z < 7) {
        const Voxel* first = voxel(base);
        if (!first) return result;
        for (int c = 0; c < 8; ++c) {
            result[std::size_t(c)] = first + (c & 1) + 8 * ((c >> 1) & 1) + 64 * (c >> 2);
        }
        return result;
    }
    for (int c = 0; c < 8; ++c) {
        result[std::size_t(c)] = voxel(base + glm::ivec3(c & 1, (c >> 1) & 1, c >> 2));
    }
    return result;
}

float VolumeSampler::distance(const glm::vec3& p) {
    const glm::vec3 base = glm::floor(p);
    const auto voxels = corners(glm::ivec3(base));
    float sum = 0;
    for (int c = 0; c < 8; ++c) {
        const Voxel* v = voxels[std::size_t(c)];
        if (!v || v->weight == 0) return unknown_distance;
        sum += corner_weight(c, p - base) * v->distance;
    }
    return sum;
}

glm::vec3 VolumeSampler::gradient(const glm::vec3& p) {
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

std::optional<Rgb> volume_color(VolumeSampler& sampler, const glm::vec3& p_voxels) {
    const glm::vec3 base = glm::floor(p_voxels);
    const auto voxels = sampler.corners(glm::ivec3(base));
    Rgb sum(0);
    float weight = 0;
    for (int c = 0; c < 8; ++c) {
        const Voxel* v = voxels[std::size_t(c)];
        if (!v || v->color_weight == 0) continue;
        const float w = corner_weight(c, p_voxels - base) + 1e-6f;  // so that one voxel is enough
        sum += w * Rgb(v->color[0], v->color[1], v->color[2]);
        weight += w;
    }
    if (weight == 0) return std::nullopt;
    return sum / (weight * 65535.0f);
}

std::optional<Rgb> volume_color(const VoxelVolume& volume, const glm::vec3& p_world) {
    VolumeSampler sampler(volume);
    return volume_color(sampler, p_world / volume.voxel_size);
}

}  // namespace inlay
