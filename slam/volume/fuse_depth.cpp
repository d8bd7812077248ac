#include "slam/volume/fuse_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/volume/allocate_bricks.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr float most_color_weight = 64;  // observations; then the mean slides

/// What one frame says about space.
struct Observation {
    SurfaceMap surface;
    Image<float> weight;  // observations that each pixel counts for, 0: not fused
    Image<Rgb> color;     // linear; empty: none
    CameraView view;
    glm::mat3 camera_from_world;
    glm::vec3 translation;  // m, of camera_from_world
};

float observation_weight(const glm::vec3& p, const glm::vec3& n, const FusionSettings& settings) {
    const float cosine = -glm::dot(p, n) / glm::length(p);
    if (cosine < settings.least_cosine) return 0;
    const float nearness = std::min(1.0f, settings.full_weight_z / p.z);
    return cosine * nearness * nearness;
}

Observation observe(const Image<float>& depth, const Image<EncodedRgb>& color, const Lens& lens,
                    const Pose& world_from_camera, const FusionSettings& settings) {
    const Pose camera_from_world = inverse(world_from_camera);
    Observation seen{surface_from_depth(depth, lens, world_from_camera),
                     Image<float>(lens.width, lens.height),
                     color.empty() ? Image<Rgb>() : decode(color),
                     camera_view(lens),
                     glm::mat3(camera_from_world.rotation),
                     glm::vec3(camera_from_world.translation)};
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            if (!seen.surface.has_surface(x, y)) continue;
            seen.weight(x, y) = observation_weight(seen.surface.position(x, y),
                                                   seen.surface.normal(x, y), settings);
        }
    });
    return seen;
}

void fold_color(Voxel& voxel, const Rgb& color) {
    const float old = voxel.color_weight;
    for (int i = 0; i < 3; ++i) {
        std::uint16_t& channel = voxel.color[std::size_t(i)];
        const float mean = (old * float(channel) + 65535.0f * color[i]) / (old + 1);
        channel = std::uint16_t(std::clamp(mean, 0.0f, 65535.0f) + 0.5f);
    }
    voxel.color_weight = std::uint16_t(std::min(old + 1, most_color_weight));
}

/// Curless and Levoy 1996, eq. 3 and 4.
void fold_distance(Voxel& voxel, float distance, float weight, float max_weight) {
    voxel.distance = (voxel.weight * voxel.distance + weight * distance) / (voxel.weight + weight);
    voxel.weight = std::min(voxel.weight + weight, max_weight);
}

void fold(Voxel& voxel, const glm::vec3& p, const Observation& seen, float truncation,
          float max_weight) {
    const int at = seen.view.pixel_of(p);
    if (at < 0) return;
    const auto pixel = std::size_t(at);
    const float weight = seen.weight.pixels[pixel];
    if (weight == 0) return;
    const glm::vec3 from_surface = p - seen.surface.position.pixels[pixel];
    const float behind = from_surface.z * glm::length(p) / p.z;
    if (behind > truncation) return;
    const float distance = glm::dot(from_surface, seen.surface.normal.pixels[pixel]) / truncation;
    if (distance < -1) return;
    fold_distance(voxel, std::min(1.0f, behind < -truncation ? 1.0f : distance), weight,
                  max_weight);
    if (!seen.color.empty() && std::abs(distance) < 0.5f) {
        fold_color(voxel, seen.color.pixels[pixel]);
    }
}

/// Whether a ball (m, camera frame) may hold points that the camera sees.
bool in_view(const glm::vec3& centre, float radius, const CameraView& view) {
    if (centre.z + radius <= 0) return false;
    const auto beyond = [&](float edge, float along, float sign) {
        return sign * (along - edge * centre.z) > radius * std::sqrt(1 + edge * edge);
    };
    return !beyond(view.highest.x, centre.x, 1) && !beyond(view.lowest.x, centre.x, -1) &&
           !beyond(view.highest.y, centre.y, 1) && !beyond(view.lowest.y, centre.y, -1);
}

void fold_brick(Brick& brick, float voxel_size, float truncation, const Observation& seen,
                float max_weight) {
    const auto camera_point = [&](const glm::vec3& voxel) {
        return seen.camera_from_world * (voxel * voxel_size) + seen.translation;
    };
    const glm::vec3 first(brick.key * brick_side);
    const float radius = voxel_size * float(brick_side) * 0.87f;  // half a brick's diagonal
    if (!in_view(camera_point(first + 3.5f), radius, seen.view)) return;
    std::size_t slot = 0;
    for (int k = 0; k < brick_side; ++k) {
        for (int j = 0; j < brick_side; ++j) {
            for (int i = 0; i < brick_side; ++i, ++slot) {
                fold(brick.voxels[slot], camera_point(first + glm::vec3(i, j, k)), seen, truncation,
                     max_weight);
            }
        }
    }
}

}  // namespace

void validate(const FusionSettings& s) {
    require(s.voxel_size >= 1e-4f && s.voxel_size <= 1.0f,
            "slam.fusion.voxel_size must be 0.0001..1 m", ExitCode::usage);
    require(s.truncation >= 2 * s.voxel_size && s.truncation <= 64 * s.voxel_size,
            "slam.fusion.truncation must span 2..64 voxels", ExitCode::usage);
    require(s.max_weight >= 1 && s.full_weight_z > 0,
            "slam.fusion.max_weight must be 1 or more and slam.fusion.full_weight_z above 0",
            ExitCode::usage);
    require(s.least_cosine >= 0 && s.least_cosine < 1, "slam.fusion.least_cosine must be 0..1",
            ExitCode::usage);
}

VoxelVolume make_volume(const FusionSettings& settings) {
    validate(settings);
    VoxelVolume volume;
    volume.voxel_size = settings.voxel_size;
    volume.truncation = settings.truncation;
    return volume;
}

void fuse_depth(VoxelVolume& volume, const Image<float>& depth, const Image<EncodedRgb>& color,
                const Lens& lens, const Pose& world_from_camera, const FusionSettings& settings) {
    require(color.empty() || same_size(color, depth), "color and depth differ in size");
    const Observation seen = observe(depth, color, lens, world_from_camera, settings);
    allocate_bricks(volume, seen.surface);
    parallel_for(int(volume.bricks.size()), [&](int i) {
        fold_brick(volume.bricks[std::size_t(i)], volume.voxel_size, volume.truncation, seen,
                   settings.max_weight);
    });
}

}  // namespace inlay
