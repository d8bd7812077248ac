#include "slam/volume/fuse_depth.h"

#include "recordings/base/check.h"
#include "recordings/base/lanes.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/depth/surface_from_depth.h"
#include "slam/volume/allocate_bricks.h"
#include "slam/volume/bricks_in_view.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr float most_color_weight = 64;  // observations; then the mean slides

/// What one pixel says about the space around its surface. All zero: nothing.
struct PixelPlane {
    glm::vec3 normal{0};  // camera frame
    float offset = 0;     // m: points of the plane have dot(normal, p) = offset
    float z = 0;          // m, of the surface
    float weight = 0;     // observations that it counts for
};

/// What one frame says about space.
struct Observation {
    Image<PixelPlane> planes;
    CameraView view;
    const Image<EncodedRgb>& color;  // empty: none
    CameraView color_view;
    glm::mat3 color_rotation;
    glm::vec3 color_translation;  // m, from the depth camera's frame to the color camera's
    Rgb color_scale;              // undoes the photograph's gain
    glm::mat3 camera_from_world;
    glm::vec3 translation;  // m, of camera_from_world
};

float observation_weight(const glm::vec3& p, const glm::vec3& n, const FusionSettings& settings) {
    const float cosine = -glm::dot(p, n) / glm::length(p);
    if (cosine < settings.least_cosine) return 0;
    const float nearness = std::min(1.0f, settings.full_weight_z / p.z);
    return cosine * nearness * nearness;
}

Observation observe(const SurfaceMap& surface, const SeenColor& color,
                    const FusionSettings& settings) {
    const Pose camera_from_world = inverse(surface.world_from_camera);
    const Lens& lens = surface.lens;
    Observation seen{Image<PixelPlane>(lens.width, lens.height),
                     camera_view(lens),
                     color.image,
                     color.image.empty() ? CameraView{} : camera_view(color.lens),
                     glm::mat3(color.color_from_depth.rotation),
                     glm::vec3(color.color_from_depth.translation),
                     1.0f / color.gain,
                     glm::mat3(camera_from_world.rotation),
                     glm::vec3(camera_from_world.translation)};
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            if (!surface.has_surface(x, y)) continue;
            const glm::vec3 &p = surface.position(x, y), &n = surface.normal(x, y);
            seen.planes(x, y) = {n, glm::dot(n, p), p.z, observation_weight(p, n, settings)};
        }
    });
    return seen;
}

/// A clipped channel says that its color is no less: where one is known already, it can only raise
/// it.
void fold_color(Brick& brick, std::size_t slot, const EncodedRgb& pixel, const Rgb& scale) {
    const float old = brick.color_weight[slot];
    const Rgb color = 65535.0f * decode(pixel) * scale;
    const std::array<int, 3> bytes{pixel.r, pixel.g, pixel.b};
    for (int i = 0; i < 3; ++i) {
        std::uint16_t& channel = brick.color[std::size_t(i)][slot];
        const bool at_least = old > 0 && bytes[std::size_t(i)] >= clipped_byte;
        const float value = at_least ? std::max(color[i], float(channel)) : color[i];
        const float mean = (old * float(channel) + value) / (old + 1);
        channel = std::uint16_t(std::clamp(mean, 0.0f, 65535.0f) + 0.5f);
    }
    brick.color_weight[slot] = std::uint16_t(std::min(old + 1, most_color_weight));
}

/// Folds the photograph's colors into those of eight voxels that are `near` the surface.
void fold_colors(Brick& brick, std::size_t slot, const Vectors& p, const Lanes& near,
                 const Observation& seen) {
    const SeenAt at =
        seen.color_view.pixels_of(transformed(seen.color_rotation, p, seen.color_translation));
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        if (!near[lane] || !at.seen[lane]) continue;
        fold_color(brick, slot + lane, seen.color.pixels[std::size_t(at.pixel[lane])],
                   seen.color_scale);
    }
}

/// Folds what the frame says into the voxels of a brick from `slot` on, which are at `p`.
/// Curless and Levoy 1996, eq. 3 and 4.
void fold_row(Brick& brick, std::size_t slot, const Vectors& p, const Observation& seen,
              float truncation, float max_weight) {
    const SeenAt at = seen.view.pixels_of(p);
    if (none_of(at.seen)) return;
    const auto read = [&](auto member) {
        return Floats(
            [&](auto lane) { return member(seen.planes.pixels[std::size_t(at.pixel[lane])]); });
    };
    const Floats weight = read([](const PixelPlane& q) { return q.weight; });
    const Floats beyond = p.z - read([](const PixelPlane& q) { return q.z; });
    Lanes folded = at.seen && weight > 0;
    const Floats behind = beyond * stdx::sqrt(dot(p, p)) / choose(folded, p.z, 1);
    folded = folded && behind <= truncation;
    if (none_of(folded)) return;
    const Vectors normal{read([](const PixelPlane& q) { return q.normal.x; }),
                         read([](const PixelPlane& q) { return q.normal.y; }),
                         read([](const PixelPlane& q) { return q.normal.z; })};
    const Floats offset = read([](const PixelPlane& q) { return q.offset; });
    const Floats distance = (dot(p, normal) - offset) / truncation;
    folded = folded && distance >= -1;
    const Floats value = choose(behind < -truncation, 1, stdx::min(distance, Floats(1)));
    Floats mean(&brick.distance[slot], stdx::vector_aligned);
    Floats sum(&brick.weight[slot], stdx::vector_aligned);
    where(folded, mean) = (sum * mean + weight * value) / choose(folded, sum + weight, 1);
    where(folded, sum) = stdx::min(sum + weight, Floats(max_weight));
    mean.copy_to(&brick.distance[slot], stdx::vector_aligned);
    sum.copy_to(&brick.weight[slot], stdx::vector_aligned);
    const Lanes near = folded && stdx::abs(distance) < 0.5f;
    if (!seen.color.empty() && any_of(near)) fold_colors(brick, slot, p, near, seen);
}

void fold_brick(Brick& brick, float voxel_size, const Observation& seen, float truncation,
                float max_weight) {
    const glm::vec3 step = seen.camera_from_world[0] * voxel_size;
    const Floats lane = lane_numbers();
    const Vectors steps{lane * step.x, lane * step.y, lane * step.z};
    for (int row = 0; row < brick_side * brick_side; ++row) {
        const glm::ivec3 first =
            brick.key * brick_side + glm::ivec3(0, row % brick_side, row / brick_side);
        const glm::vec3 p =
            seen.camera_from_world * (glm::vec3(first) * voxel_size) + seen.translation;
        fold_row(brick, std::size_t(row) * brick_side,
                 {p.x + steps.x, p.y + steps.y, p.z + steps.z}, seen, truncation, max_weight);
    }
}

float farthest_of(const SurfaceMap& surface) {
    float farthest = 0;
    for (const glm::vec3& p : surface.position.pixels)
        farthest = std::max(farthest, p.z);
    return farthest;
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
    require(s.memory >= 1, "slam.fusion.memory must be 1 MB or more", ExitCode::usage);
    require(s.least_cosine >= 0 && s.least_cosine < 1, "slam.fusion.least_cosine must be 0..1",
            ExitCode::usage);
}

VoxelVolume make_volume(const FusionSettings& settings) {
    validate(settings);
    VoxelVolume volume;
    volume.voxel_size = settings.voxel_size;
    volume.truncation = settings.truncation;
    volume.most_bricks = (std::size_t(settings.memory) << 20) / sizeof(Brick);
    return volume;
}

void fuse_surface(VoxelVolume& volume, const SurfaceMap& surface, const SeenColor& color,
                  const FusionSettings& settings) {
    require(color.image.empty() ||
                (color.image.width == color.lens.width && color.image.height == color.lens.height),
            "the color image and its lens differ in size");
    const Observation seen = observe(surface, color, settings);
    allocate_bricks(volume, surface);
    const std::vector<int> bricks =
        bricks_in_view(volume, seen.view, inverse(surface.world_from_camera), 0,
                       farthest_of(surface) + 2 * volume.truncation);
    parallel_for(int(bricks.size()), [&](int i) {
        fold_brick(volume.bricks[std::size_t(bricks[std::size_t(i)])], volume.voxel_size, seen,
                   volume.truncation, settings.max_weight);
    });
}

void fuse_depth(VoxelVolume& volume, const Image<float>& depth, const Image<EncodedRgb>& color,
                const Lens& lens, const Pose& world_from_camera, const FusionSettings& settings) {
    fuse_surface(volume, surface_from_depth(depth, lens, world_from_camera), {color, lens, Pose{}},
                 settings);
}

}  // namespace inlay
