#include "apps/bench/thesis_rays.h"

#include "render/sample/warp.h"
#include "render/trace/landing.h"
#include "render/trace/pixel_tile.h"

namespace inlay {
namespace {

constexpr int camera_rays_per_pixel = 4, light_samples_per_ray = 4;

enum Dimension : std::uint32_t { in_pixel, to_light, over_hemisphere, to_light_at_hit };

struct Mode {
    const Work& work;
    const TrackedFrame& frame;
    const EmbreeScene& objects;
    const BareScene& whole;
    BareRays& rays;

    void add_tile(const PixelTile& tile) const;
    void add_shadow_rays(const Landings& landings, const SampleKeys& keys) const;
    void add_indirect_rays(const Landings& landings, const SampleKeys& keys) const;
};

/// Whether rays leave from here.
bool is_surface(const Landing& landing) { return landing.kind != LandingKind::nothing; }

void Mode::add_shadow_rays(const Landings& landings, const SampleKeys& keys) const {
    RayPacket shadow;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = landings[i];
        if (!is_surface(from)) continue;
        const LightSample light =
            sample_environment(work.environment, stratified_pair(keys[i], to_light));
        if (!(light.pdf > 0 && glm::dot(light.direction, from.normal) > 0)) continue;
        shadow.set(lane,
                   ray_origin(from.position, from.geometric_normal, light.direction,
                              frame.geometry.offset),
                   light.direction);
    }
    rays.add(shadow, /*nearest=*/false);
}

void Mode::add_indirect_rays(const Landings& landings, const SampleKeys& keys) const {
    RayPacket indirect, shadow;
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        const Landing& from = landings[i];
        if (!is_surface(from)) continue;
        const glm::vec3 direction =
            basis_about(from.normal) *
            sample_cosine_hemisphere(stratified_pair(keys[i], over_hemisphere)).direction;
        indirect.set(
            lane,
            ray_origin(from.position, from.geometric_normal, direction, frame.geometry.offset),
            direction);
    }
    if (indirect.active == 0) return;
    rays.add(indirect, /*nearest=*/true);
    const BareHits hits = nearest_hits(whole, rays.packets.back());
    for (int lane = 0; lane < packet_width; ++lane) {
        const auto i = std::size_t(lane);
        if (!indirect.has(lane) || hits.distance[i] == no_hit) continue;
        const glm::vec3 &d = indirect.direction[i], &n = hits.normal[i];
        const LightSample light =
            sample_environment(work.environment, stratified_pair(keys[i], to_light_at_hit));
        if (!(light.pdf > 0 && glm::dot(light.direction, n) > 0)) continue;
        const glm::vec3 at = indirect.origin[i] + hits.distance[i] * d;
        shadow.set(lane, at + frame.geometry.offset * n, light.direction);
    }
    rays.add(shadow, /*nearest=*/false);
}

void Mode::add_tile(const PixelTile& tile) const {
    for (int p = 0; p < camera_rays_per_pixel; ++p) {
        SampleKeys keys =
            sample_keys(tile, frame.lens, {1, std::uint32_t(frame.frame), 0, std::uint32_t(p)});
        const RayPacket camera =
            camera_rays(tile, frame.lens, frame.world_from_camera, pixel_shifts(keys, in_pixel));
        rays.add(camera, /*nearest=*/true);
        const Landings landings =
            land(frame.geometry, objects, camera, tile.pixels, frame.depth_tolerance);
        for (int s = 0; s < light_samples_per_ray; ++s) {
            for (SampleKey& key : keys)
                key.sample = std::uint32_t(p * light_samples_per_ray + s);
            add_shadow_rays(landings, keys);
            add_indirect_rays(landings, keys);
        }
    }
}

}  // namespace

BareRays thesis_rays(const Work& work, const TrackedFrame& frame, const EmbreeScene* objects,
                     const BareScene& whole) {
    const EmbreeScene none;
    BareRays rays;
    const Mode mode{work, frame, objects ? *objects : none, whole, rays};
    for (int row = 0; row < tile_rows(frame.lens); ++row)
        for (int column = 0; column < tile_columns(frame.lens); ++column)
            mode.add_tile(tile_at(frame.lens, column, row));
    return rays;
}

}  // namespace inlay
