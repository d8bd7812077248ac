// Pictures as PNG files whose bytes depend on the pixels alone.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace inlay {

/// A PNG file in memory: 8 bits for each of R, G, B (sRGB). Throws Error (bad_data) for an empty
/// image.
std::vector<std::byte> encode_png(const Image<EncodedRgb>& image);

/// A PNG file in memory: 16-bit grey, for raw depth. Throws Error (bad_data) for an empty image.
std::vector<std::byte> encode_png(const Image<std::uint16_t>& image);

/// Writes a PNG file; throws Error (cannot_create, disk_fault) as write_file does.
void write_png(const std::filesystem::path& file, const Image<EncodedRgb>& image);
void write_png(const std::filesystem::path& file, const Image<std::uint16_t>& image);

}  // namespace inlay
