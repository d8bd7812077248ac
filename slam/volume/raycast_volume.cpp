#include "slam/volume/raycast_volume.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/volume/brick_grid.h"
#include "slam/volume/ray_ranges.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace inlay {
namespace {

constexpr float surely_far = 0.7f;  // of the truncation; nearer, the field is read trilinearly
constexpr float parallel = 1e-12f;  // to an axis: directions that never leave a brick by it
constexpr int refinements = 2;      // of a crossing

/// Eight neighbouring pixels' rays in the voxels of a grid, by z in metres.
struct Rays {
    glm::vec3 eye;               // voxels
    Vectors direction, inverse;  // voxels per metre of z, and metres of z per voxel
    Floats truncation;           // m of z that a ray needs for one truncation
    Floats voxel;                // m of z that it needs for one voxel
    Floats nearest, farthest;    // m, where it looks
    std::array<const ZRange*, lane_count> ranges;

    Vectors at(const Floats& z) const {
        return {eye.x + z * direction.x, eye.y + z * direction.y, eye.z + z * direction.z};
    }
};

/// z where rays that are at `z` leave the cells of the bricks that hold the points, and a little
/// more, or where the next bricks are.
Floats next_brick(const Rays& rays, const Vectors& p, const Floats& z_here) {
    const auto ahead = [](const Floats& x, const Floats& direction, const Floats& inverse) {
        const Floats first = stdx::floor((x + 0.5f) * (1.0f / brick_side)) * float(brick_side);
        const Floats wall = first + choose(direction > 0, brick_side - 0.5f, -0.5f);
        return choose(stdx::abs(direction) > parallel, (wall - x) * inverse, 1e30f);
    };
    const Floats x = ahead(p.x, rays.direction.x, rays.inverse.x);
    const Floats y = ahead(p.y, rays.direction.y, rays.inverse.y);
    const Floats z = ahead(p.z, rays.direction.z, rays.inverse.z);
    const Floats beyond =
        z_here + stdx::max(stdx::min(stdx::min(x, y), z), Floats(0)) + 0.02f * rays.voxel;
    return Floats([&](auto lane) {
        return std::min(rays.ranges[lane]->occupied_from(beyond[lane]), rays.farthest[lane] + 1);
    });
}

/// Where rays pass from the free side (z0, d0 > 0) to the other (z1, d1 <= 0).
struct Crossings {
    Lanes met{false};
    Floats z0 = 0, d0 = 1, z1 = 0, d1 = 0;

    Floats z() const { return z0 + (z1 - z0) * d0 / (d0 - d1); }
};

/// The first passages in the ranges.
Crossings first_crossings(const BrickGrid& grid, const Rays& rays) {
    Crossings found;
    Floats z = rays.nearest, z_free = 0, d_free = -1;  // the last points known to be free
    Lanes going = z <= rays.farthest;
    while (any_of(going)) {
        const Vectors p = rays.at(z);
        Floats d = grid.nearest_distance(p);
        const Lanes absent = d > unknown_distance;
        const Lanes near = going && stdx::abs(d) < surely_far;
        if (any_of(near)) where(near, d) = grid.distance(p);
        const Lanes met = going && d <= 0 && d_free > 0;
        found.met = found.met || met;
        where(met, found.z0) = z_free;
        where(met, found.d0) = d_free;
        where(met, found.z1) = z;
        where(met, found.d1) = d;
        const Lanes free = d > 0 && d < 1.5f;
        d_free = choose(free, d, -1);
        z_free = z;
        // Near a surface that it faces, a ray steps behind it, by half a voxel.
        const Floats past = choose(near, 0.5f * rays.voxel, 0);
        const Floats next = z + choose(free, d * rays.truncation + past, rays.voxel);
        going = going && !met;
        where(going, z) = next;
        if (any_of(absent && going)) where(absent && going, z) = next_brick(rays, p, z_free);
        going = going && z <= rays.farthest;
    }
    return found;
}

/// Sharpens crossings by regula falsi.
void refine(Crossings& found, const BrickGrid& grid, const Rays& rays) {
    for (int i = 0; i < refinements; ++i) {
        const Floats z = found.z(), d = grid.distance(rays.at(z));
        const Lanes free = found.met && d > 0 && d < 1.5f, solid = found.met && d < 0;
        where(free, found.z0) = z;
        where(free, found.d0) = d;
        where(solid, found.z1) = z;
        where(solid, found.d1) = d;
    }
}

/// What a raycast works on.
struct View {
    const BrickGrid& grid;
    const CameraView& camera;
    const RayRanges& ranges;
    const RaycastSettings& settings;
    glm::mat3 voxels_from_camera;  // directions: voxels per metre
    glm::mat3 camera_from_world;
    glm::vec3 eye;     // voxels of the grid
    float truncation;  // m
};

Floats safe_inverse(const Floats& x) { return 1 / choose(stdx::abs(x) > parallel, x, 1); }

/// The rays of pixels (x, y) to (x + 7, y); those beyond the row look nowhere.
Rays rays_of(const View& view, int x, int y) {
    const Image<glm::vec3>& table = *view.camera.rays;
    Rays rays;
    std::array<glm::vec3, lane_count> directions;
    std::array<float, lane_count> length, nearest, farthest;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        const int column = x + int(lane);
        const glm::vec3& ray = table(std::min(column, table.width - 1), y);
        const ZRange& range = view.ranges.of(ray);
        directions[lane] = view.voxels_from_camera * ray;
        length[lane] = glm::length(ray);
        nearest[lane] = range.occupied != 0 ? range.nearest : view.settings.nearest;
        farthest[lane] = std::min(range.farthest, view.settings.farthest);
        if (column >= table.width) farthest[lane] = -1;
        rays.ranges[lane] = &range;
    }
    rays.eye = view.eye;
    rays.direction = {Floats([&](auto lane) { return directions[lane].x; }),
                      Floats([&](auto lane) { return directions[lane].y; }),
                      Floats([&](auto lane) { return directions[lane].z; })};
    rays.inverse = {safe_inverse(rays.direction.x), safe_inverse(rays.direction.y),
                    safe_inverse(rays.direction.z)};
    rays.truncation = view.truncation / Floats(length.data(), stdx::element_aligned);
    rays.voxel = 1 / stdx::sqrt(dot(rays.direction, rays.direction));
    rays.nearest.copy_from(nearest.data(), stdx::element_aligned);
    rays.farthest.copy_from(farthest.data(), stdx::element_aligned);
    return rays;
}

/// Writes what the rays of pixels from (x, y) on met at `z`.
void write(SurfaceMap& map, int x, int y, const View& view, const Rays& rays,
           const Crossings& found) {
    const auto z = numbers_of(found.z());
    const Vectors p = rays.at(found.z());
    const Vectors gradient = view.grid.gradient(p);
    const Floats steepness = stdx::sqrt(dot(gradient, gradient));
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
        if (!found.met[lane] || !(steepness[lane] > 0)) continue;
        const float weight = view.grid.nearest_weight({p.x[lane], p.y[lane], p.z[lane]});
        if (weight <= view.settings.least_weight) continue;
        const glm::vec3& ray = (*view.camera.rays)(x + int(lane), y);
        const glm::vec3 normal =
            view.camera_from_world *
            (glm::vec3(gradient.x[lane], gradient.y[lane], gradient.z[lane]) / steepness[lane]);
        if (glm::dot(normal, ray) >= 0) continue;
        const auto pixel = map.position.index(x + int(lane), y);
        map.position.pixels[pixel] = z[lane] * ray;
        map.normal.pixels[pixel] = normal;
        map.confidence.pixels[pixel] = std::min(1.0f, weight / view.settings.full_confidence);
    }
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
    const CameraView camera = camera_view(lens);
    const RayRanges ranges =
        ray_ranges(volume, camera, inverse(world_from_camera), settings.nearest, settings.farthest);
    if (ranges.bricks.empty()) return map;
    const BrickGrid grid(volume, ranges.bricks);
    const double voxels_per_metre = 1.0 / double(volume.voxel_size);
    const View view{
        grid,
        camera,
        ranges,
        settings,
        glm::mat3(world_from_camera.rotation * voxels_per_metre),
        glm::mat3(glm::transpose(world_from_camera.rotation)),
        glm::vec3(world_from_camera.translation * voxels_per_metre - glm::dvec3(grid.origin())),
        volume.truncation};
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; x += lane_count) {
            const Rays rays = rays_of(view, x, y);
            Crossings found = first_crossings(grid, rays);
            if (!any_of(found.met)) continue;
            refine(found, grid, rays);
            write(map, x, y, view, rays, found);
        }
    });
    return map;
}

}  // namespace inlay
