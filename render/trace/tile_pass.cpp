#include "render/trace/tile_pass.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

/// A place far from those of the pixel's neighbors.
std::uint32_t scattered_place(std::uint32_t pixel) { return hash(pixel) >> 8; }

}  // namespace

SampleKeys TilePass::keys(int sample) const {
    SampleKeys keys = tile.keys;
    for (SampleKey& key : keys)
        key.sample = std::uint32_t(sample);
    return keys;
}

Landings TilePass::land_at(int sample, std::uint32_t lanes) const {
    std::array<glm::vec2, packet_width> shifts;
    for (std::size_t i = 0; i < packet_width; ++i)
        shifts[i] = tile.in_pixel[i].at(std::uint32_t(sample)) - glm::vec2(0.5f);
    RayPacket rays = camera_rays(tile.area, scene.lens, scene.world_from_camera, shifts);
    rays.active &= lanes;
    tile.rays.primary += std::uint64_t(std::popcount(rays.active));
    static const EmbreeScene none;
    return land(scene.real, settings.virtual_seen ? scene.virtual_objects : none, rays,
                tile.area.pixels, settings.depth_tolerance);
}

SamplePass TilePass::from(const Landings& landings, const SampleKeys& at) const {
    return {scene, settings, landings, at, tile.sums, tile.rays, nets, tile.runs};
}

Tile make_tile(const PixelTile& area, const Lens& lens, const SamplingSettings& settings,
               std::uint32_t frame) {
    Tile tile;
    tile.area = area;
    tile.keys = sample_keys(area, lens, {settings.seed, frame, 0, 0, 0});
    if (!settings.spread)
        for (SampleKey& key : tile.keys)
            key.place = scattered_place(key.pixel);
    for (std::size_t i = 0; i < packet_width; ++i)
        tile.in_pixel[i] = stratified_set(tile.keys[i], position_in_pixel);
    return tile;
}

std::uint32_t lanes_of(const PixelTile& area, const Image<std::uint8_t>& chosen) {
    if (chosen.empty()) return area.inside;
    std::uint32_t lanes = 0;
    for (int lane = 0; lane < packet_width; ++lane) {
        const glm::ivec2 p = area.pixels[std::size_t(lane)];
        if (area.has(lane) && chosen(p.x, p.y) != 0) lanes |= 1U << lane;
    }
    return lanes;
}

Landings only(LandingKind kind, const Landings& landings) {
    Landings result;
    for (std::size_t lane = 0; lane < packet_width; ++lane)
        if (landings[lane].kind == kind) result[lane] = landings[lane];
    return result;
}

bool any_landing(const Landings& landings) {
    return std::any_of(landings.begin(), landings.end(),
                       [](const Landing& landing) { return landing.kind != LandingKind::nothing; });
}

}  // namespace inlay
