#include "render/trace/pixel_tile.h"

namespace inlay {
namespace {

constexpr int tile_side = 4;
static_assert(tile_side * tile_side == packet_width);

int tiles_along(int pixels) { return (pixels + tile_side - 1) / tile_side; }

}  // namespace

int tile_rows(const Lens& lens) { return tiles_along(lens.height); }
int tile_columns(const Lens& lens) { return tiles_along(lens.width); }

PixelTile tile_at(const Lens& lens, int column, int row) {
    PixelTile tile;
    for (int lane = 0; lane < packet_width; ++lane) {
        const glm::ivec2 p{column * tile_side + lane % tile_side,
                           row * tile_side + lane / tile_side};
        tile.pixels[std::size_t(lane)] = p;
        if (p.x < lens.width && p.y < lens.height) tile.inside |= 1U << lane;
    }
    return tile;
}

SampleKeys sample_keys(const PixelTile& tile, const Lens& lens, const SampleKey& frame_and_sample) {
    SampleKeys keys;
    for (std::size_t i = 0; i < packet_width; ++i) {
        keys[i] = frame_and_sample;
        keys[i].pixel = std::uint32_t(tile.pixels[i].y * lens.width + tile.pixels[i].x);
        keys[i].place =
            place_along_curve(std::uint32_t(tile.pixels[i].x), std::uint32_t(tile.pixels[i].y));
    }
    return keys;
}

RayPacket camera_rays(const PixelTile& tile, const Lens& lens, const Pose& world_from_camera,
                      const std::array<glm::vec2, packet_width>& shift) {
    RayPacket rays;
    rays.coherent = true;
    const glm::vec3 origin(world_from_camera.translation);
    for (int lane = 0; lane < packet_width; ++lane) {
        if (!tile.has(lane)) continue;
        const auto i = std::size_t(lane);
        const glm::dvec3 in_camera =
            unproject(lens, glm::dvec2(tile.pixels[i]) + glm::dvec2(shift[i]));
        rays.set(lane, origin, glm::vec3(glm::normalize(world_from_camera.rotation * in_camera)));
    }
    return rays;
}

std::array<glm::vec2, packet_width> pixel_shifts(const SampleKeys& keys, std::uint32_t dimension) {
    std::array<glm::vec2, packet_width> shifts;
    for (std::size_t i = 0; i < packet_width; ++i)
        shifts[i] = stratified_pair(keys[i], dimension) - glm::vec2(0.5f);
    return shifts;
}

}  // namespace inlay
