#include "render/trace/picture.h"

#include "recordings/base/parallel.h"
#include "render/trace/pixel_sums.h"
#include "render/trace/pixel_tile.h"

#include <algorithm>
#include <vector>

namespace inlay {
namespace {

/// A sum over samples that also knows how far its mean may be off.
struct SumWithSpread {
    SampleSum samples;
    glm::dvec3 squares{0.0};

    void add(const Rgb& value) {
        if (samples.add(value)) squares += glm::dvec3(value) * glm::dvec3(value);
    }
    Rgb standard_error() const {
        const double count = samples.count;
        if (count < 2) return Rgb(0);
        const glm::dvec3 mean = samples.sum / count;
        const glm::dvec3 spread = glm::max(squares - count * mean * mean, glm::dvec3(0));
        return Rgb(glm::sqrt(spread / (count * (count - 1))));
    }
};

}  // namespace

Picture trace_picture(const EmbreeScene& scene, const EnvironmentSampler& environment,
                      const PictureView& view, int samples) {
    const Lens& lens = view.lens;
    Picture picture{Image<Rgb>(lens.width, lens.height), Image<Rgb>(lens.width, lens.height)};
    std::vector<std::uint64_t> dropped(std::size_t(tile_rows(lens)), 0);
    PathSettings settings;
    settings.dimension = 1;  // 0 is the position within the pixel
    parallel_for(tile_rows(lens), [&](int row) {
        for (int column = 0; column < tile_columns(lens); ++column) {
            const PixelTile tile = tile_at(lens, column, row);
            std::array<SumWithSpread, packet_width> sums;
            for (int s = 0; s < samples; ++s) {
                const SampleKeys keys =
                    sample_keys(tile, lens, {view.seed, view.frame, 0, std::uint32_t(s)});
                const RayPacket rays =
                    camera_rays(tile, lens, view.world_from_camera, pixel_shifts(keys, 0));
                const RadiancePacket radiance =
                    trace_paths(scene, environment, rays, keys, settings);
                for (std::size_t i = 0; i < packet_width; ++i)
                    sums[i].add(radiance[i]);
            }
            for (int lane = 0; lane < packet_width; ++lane) {
                if (!tile.has(lane)) continue;
                const auto i = std::size_t(lane);
                picture.radiance(tile.pixels[i].x, tile.pixels[i].y) = sums[i].samples.mean();
                picture.standard_error(tile.pixels[i].x, tile.pixels[i].y) =
                    sums[i].standard_error();
                dropped[std::size_t(row)] += std::uint64_t(sums[i].samples.dropped);
            }
        }
    });
    for (const std::uint64_t d : dropped)
        picture.dropped_samples += d;
    return picture;
}

Image<float> trace_depth(const EmbreeScene& scene, const Lens& lens,
                         const Pose& world_from_camera) {
    Image<float> depth(lens.width, lens.height);
    const Pose camera_from_world = inverse(world_from_camera);
    parallel_for(tile_rows(lens), [&](int row) {
        for (int column = 0; column < tile_columns(lens); ++column) {
            const PixelTile tile = tile_at(lens, column, row);
            const RayPacket rays = camera_rays(tile, lens, world_from_camera, {});
            const HitPacket hits = scene.intersect(rays);
            for (int lane = 0; lane < packet_width; ++lane) {
                const auto i = std::size_t(lane);
                if (!tile.has(lane) || !hits[i].hit()) continue;
                const SurfacePoint p =
                    scene.surface_point(hits[i], rays.origin[i], rays.direction[i]);
                depth(tile.pixels[i].x, tile.pixels[i].y) =
                    float((camera_from_world * glm::dvec3(p.position)).z);
            }
        }
    });
    return depth;
}

}  // namespace inlay
