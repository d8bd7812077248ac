#include "recordings/environment/latlong_files.h"

#include "recordings/base/check.h"
#include "recordings/environment/exr_image.h"
#include "recordings/environment/hdr_image.h"

#include <algorithm>
#include <cctype>
#include <cmath>

namespace inlay {

namespace fs = std::filesystem;

namespace {

/// Sets what is NaN, infinite or negative to 0; whether there was any.
bool mend(Rgb& texel) {
    bool mended = false;
    for (int c = 0; c < 3; ++c) {
        if (std::isfinite(texel[c]) && texel[c] >= 0) continue;
        texel[c] = 0;
        mended = true;
    }
    return mended;
}

}  // namespace

LatlongFile load_latlong(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    require(extension == ".exr" || extension == ".hdr",
            file.string() + ": ends in \"" + extension + "\"; expected .exr or .hdr");
    LatlongFile result;
    result.radiance = extension == ".exr" ? read_exr(file) : read_hdr(file);
    const Image<Rgb>& map = result.radiance;
    require(map.width == 2 * map.height,
            file.string() + ": " + std::to_string(map.width) + " x " + std::to_string(map.height) +
                " px; expected twice as wide as high (a latitude-longitude map of all directions)");
    for (Rgb& texel : result.radiance.pixels)
        result.replaced_texels += mend(texel);
    return result;
}

}  // namespace inlay
