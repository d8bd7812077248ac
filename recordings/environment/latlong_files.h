// Latitude-longitude environment maps from .exr and .hdr files.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>

namespace inlay {

/// Radiance as an EnvironmentMap holds it, and what had to be mended for that.
struct LatlongFile {
    Image<Rgb> radiance;      // finite, >= 0, width = 2 height
    int replaced_texels = 0;  // with a NaN, infinite or negative channel, which is set to 0
};

/// Reads a latitude-longitude map from an .exr or a Radiance .hdr file. Throws Error:
/// input_missing; bad_data where the file is damaged, too large (see `read_exr`), not twice as wide
/// as high, or of another kind.
LatlongFile load_latlong(const std::filesystem::path& file);

}  // namespace inlay
