// Radiance HDR files as images.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>

namespace inlay {

/// Reads a Radiance .hdr picture as linear color, row 0 at the top. Throws Error: input_missing;
/// bad_data where the file is damaged, cut off, of another kind, or more than 16384 px a side.
Image<Rgb> read_hdr(const std::filesystem::path& file);

}  // namespace inlay
