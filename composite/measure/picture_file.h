// Pictures of any kind that the program reads or writes, as they are compared.
#pragma once

#include "composite/measure/image_error.h"
#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <filesystem>
#include <string>

namespace inlay {

/// A picture in both forms; one of them is the file's own, the other follows from it.
struct ComparedPicture {
    Image<Rgb> linear;          // relative radiance; not always finite, as in the file
    Image<EncodedRgb> display;  // values that are not finite are black
};

/// Whether a file's name ends as one of the kinds that read_picture knows.
bool is_picture_name(const std::filesystem::path& file);

/// Reads a PNG or JPEG (8-bit sRGB), an OpenEXR (R, G, B or Y) or a Radiance HDR file (linear).
/// Throws Error: input_missing, or bad_data for files of another kind and damaged ones.
ComparedPicture read_picture(const std::filesystem::path& file);

/// How far one picture is from another.
struct PictureError {
    RadianceError radiance;
    DisplayError display;  // over the pixels that are finite in both
};

/// Throws Error (bad_data) when sizes differ or no pixel is finite in both.
PictureError picture_error(const ComparedPicture& picture, const ComparedPicture& reference);

}  // namespace inlay
