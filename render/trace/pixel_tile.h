// PixelTile: 4 x 4 neighboring pixels, whose rays make one packet.
#pragma once

#include "recordings/base/lens.h"
#include "recordings/base/pose.h"
#include "render/trace/path_tracer.h"

#include <array>
#include <cstdint>

namespace inlay {

struct PixelTile {
    std::array<glm::ivec2, packet_width> pixels{};
    std::uint32_t inside = 0;  // lanes whose pixel lies within the image
    bool has(int lane) const { return (inside >> lane) & 1U; }
};

/// Rows of tiles that cover an image, and tiles within a row.
int tile_rows(const Lens& lens);
int tile_columns(const Lens& lens);
PixelTile tile_at(const Lens& lens, int column, int row);

/// Keys of one sample of each pixel.
SampleKeys sample_keys(const PixelTile& tile, const Lens& lens, const SampleKey& frame_and_sample);

/// Rays through the pixels' centres moved by `shift` (px, each coordinate -1/2..1/2).
RayPacket camera_rays(const PixelTile& tile, const Lens& lens, const Pose& world_from_camera,
                      const std::array<glm::vec2, packet_width>& shift);

/// Shifts that spread the samples of a pixel over its area.
std::array<glm::vec2, packet_width> pixel_shifts(const SampleKeys& keys, std::uint32_t dimension);

}  // namespace inlay
