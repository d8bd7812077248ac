#include "render/trace/tile_pass.h"

#include <algorithm>
#include <bit>

namespace inlay {

SampleKeys TilePass::keys(int sample) const {
    return sample_keys(tile.area, scene.lens, {settings.seed, frame, 0, std::uint32_t(sample)});
}

Landings TilePass::land_at(int sample, std::uint32_t lanes) const {
    RayPacket rays = camera_rays(tile.area, scene.lens, scene.world_from_camera,
                                 pixel_shifts(keys(sample), position_in_pixel));
    rays.active &= lanes;
    tile.rays.primary += std::uint64_t(std::popcount(rays.active));
    static const EmbreeScene none;
    return land(scene.real, settings.virtual_seen ? scene.virtual_objects : none, rays,
                tile.area.pixels, settings.depth_tolerance);
}

SamplePass TilePass::from(const Landings& landings, const SampleKeys& at) const {
    return {scene, settings, landings, at, tile.sums, tile.rays, nets};
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
