#include "slam/volume/allocate_bricks.h"

#include "recordings/base/parallel.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace inlay {
namespace {

constexpr int most_stride = 8;  // px

/// The bricks of one row, with a short memory so that most repetitions never get in.
class BrickList {
public:
    void add(const glm::ivec3& key) {
        const unsigned place = unsigned(key.x * 7 + key.y * 31 + key.z * 131) % recent_.size();
        if (filled_[place] && recent_[place] == key) return;
        recent_[place] = key;
        filled_[place] = true;
        keys.push_back(key);
    }
    std::vector<glm::ivec3> keys;

private:
    std::array<glm::ivec3, 128> recent_{};
    std::array<bool, 128> filled_{};
};

/// Every brick between two points (in bricks). Amanatides and Woo 1987.
void add_line(BrickList& list, const glm::vec3& from, const glm::vec3& to) {
    constexpr float never = std::numeric_limits<float>::infinity();
    glm::ivec3 brick = glm::ivec3(glm::floor(from));
    const glm::ivec3 last = glm::ivec3(glm::floor(to));
    const glm::vec3 way = to - from;
    glm::ivec3 step(0);
    glm::vec3 next(never), every(never);
    for (int i = 0; i < 3; ++i) {
        if (brick[i] == last[i]) continue;
        step[i] = way[i] > 0 ? 1 : -1;
        every[i] = std::abs(1 / way[i]);
        next[i] = (float(brick[i] + (way[i] > 0 ? 1 : 0)) - from[i]) / way[i];
    }
    const glm::ivec3 apart = glm::abs(last - brick);
    list.add(brick);
    for (int left = apart.x + apart.y + apart.z; left > 0; --left) {
        const int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
        brick[axis] += step[axis];
        next[axis] = brick[axis] == last[axis] ? never : next[axis] + every[axis];
        list.add(brick);
    }
}

}  // namespace

void allocate_bricks(VoxelVolume& volume, const SurfaceMap& surface) {
    const float bricks_per_metre = 1.0f / (volume.voxel_size * float(brick_side));
    const glm::mat3 rotation(surface.world_from_camera.rotation);
    const glm::vec3 eye(surface.world_from_camera.translation);
    const glm::vec3 half_voxel(0.5f / float(brick_side));  // a voxel's cell is centred on it
    const auto focal_voxels =
        float(std::min(std::abs(surface.lens.fx), std::abs(surface.lens.fy))) * volume.voxel_size;
    std::vector<BrickList> rows(std::size_t(surface.lens.height));
    parallel_rows(surface.lens.height, [&](int y) {
        for (int x = 0; x < surface.lens.width; ++x) {
            if (!surface.has_surface(x, y)) continue;
            const glm::vec3& p = surface.position(x, y);
            const int stride = std::clamp(int(focal_voxels / p.z), 1, most_stride);
            if (x % stride != 0 || y % stride != 0) continue;
            const float share = volume.truncation / glm::length(p);
            const auto in_bricks = [&](float scale) {
                return (rotation * (scale * p) + eye) * bricks_per_metre + half_voxel;
            };
            add_line(rows[std::size_t(y)], in_bricks(1 - share), in_bricks(1 + share));
        }
    });
    for (const BrickList& row : rows) {
        for (const glm::ivec3& key : row.keys) {
            if (!indexable(key) || volume.index.find(key) != BrickIndex::absent) continue;
            if (volume.bricks.size() < volume.most_bricks)
                ensure_brick(volume, key);
            else
                ++volume.refused;
        }
    }
}

}  // namespace inlay
