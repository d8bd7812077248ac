// OpenEXR files as images: linear color, and all channels by name.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>
#include <string>
#include <vector>

namespace inlay {

/// One channel of an EXR file, as float whatever its type in the file.
struct ExrChannel {
    std::string name;  // with its layer: "E_R_direct.R"
    Image<float> values;
};

/// Reads the color of an EXR file: channels R, G and B, or Y alone, which is spread to three. The
/// image has the size of the display window; what lies outside the data window is 0. Scanlines or
/// tiles, any channel type and compression; of a multi-part file the first part. NaN and infinite
/// values are passed on. Throws Error: input_missing; bad_data where the file is no EXR, is cut off
/// or damaged, has neither R, G, B nor Y, or is more than 16384 px a side or 2^27 px in all.
Image<Rgb> read_exr(const std::filesystem::path& file);

/// Reads every channel of an EXR file, sorted by name. Image size and errors as `read_exr`;
/// sub-sampled channels are refused.
std::vector<ExrChannel> read_exr_channels(const std::filesystem::path& file);

}  // namespace inlay
