#include "slam/volume/bricks_in_view.h"

namespace inlay {

std::vector<int> bricks_in_view(const VoxelVolume& volume, const CameraView& view,
                                const Pose& camera_from_world, int margin, float farthest) {
    constexpr float half_diagonal = 0.87f;  // of a cube's side
    const float radius = half_diagonal * volume.voxel_size * float(brick_side + 2 * margin);
    const glm::mat3 rotation(camera_from_world.rotation);
    const glm::vec3 translation(camera_from_world.translation);
    std::vector<int> numbers;
    for (std::size_t i = 0; i < volume.keys.size(); ++i) {
        const glm::vec3 centre =
            (glm::vec3(volume.keys[i] * brick_side) + 3.5f) * volume.voxel_size;
        const glm::vec3 p = rotation * centre + translation;
        if (p.z - radius <= farthest && view.may_see(p, radius)) numbers.push_back(int(i));
    }
    return numbers;
}

}  // namespace inlay
