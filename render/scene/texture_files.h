// Textures: 8-bit pictures decoded to linear color.
#pragma once

#include "render/scene/material.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace inlay {

/// Reads a PNG or JPEG (sRGB) as linear color, row 0 at the top; an alpha channel is left out.
/// With `linear` the bytes are plain numbers, not sRGB.
/// Throws Error: input_missing; bad_data where the file is damaged, not 8-bit, or above 16384 px.
std::shared_ptr<const Texture> load_texture(const std::filesystem::path& file, bool linear = false);

/// As `load_texture` from the bytes of a file; `place` stands for it in messages.
std::shared_ptr<const Texture> decode_texture(std::span<const std::byte> bytes,
                                              const std::string& place, bool linear = false);

}  // namespace inlay
