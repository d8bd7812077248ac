// Image files: 8-bit color and 16-bit depth decoded, everything else refused; the only place of the
// readers that knows codecs.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>
#include <string>

namespace inlay {

/// What an image file says about itself before its pixels.
struct ImageHeader {
    std::string format;         // "PNG", "JPEG" or "PNM"
    int width = 0, height = 0;  // px
    int bits = 0;               // of one sample
    int channels = 0;           // 1 grey, 2 grey + alpha, 3 color, 4 color + alpha
    bool palette = false;       // PNG only
    bool operator==(const ImageHeader&) const = default;
};

/// Reads size and sample format without decoding a pixel. Throws Error: input_missing, or bad_data
/// where the file is no PNG, JPEG or PNM, is cut off within the header, or has more than 16384 px
/// a side.
ImageHeader read_image_header(const std::filesystem::path& file);

/// An 8-bit color image (grey is spread to three channels), as stored: an orientation tag turns
/// nothing. Throws Error as read_image_header, and bad_data where the samples are not 8-bit or the
/// pixels are damaged or cut off.
Image<EncodedRgb> read_color(const std::filesystem::path& file);

/// A 16-bit single-channel image as z-depth in m; stored 0 and 65535 become 0, not measured, and
/// so does what lies beyond `max_depth` (m, 0 = no limit). Throws Error as read_image_header, and
/// bad_data for 8-bit, multi-channel, palette or JPEG files and for damaged ones.
Image<float> read_depth(const std::filesystem::path& file, double units_per_metre, float max_depth);

/// Throws Error (bad_data) unless the header is one that read_depth accepts.
void require_depth_format(const std::filesystem::path& file, const ImageHeader& header);

}  // namespace inlay
