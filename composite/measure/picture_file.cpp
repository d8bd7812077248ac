#include "composite/measure/picture_file.h"

#include "recordings/base/check.h"
#include "recordings/environment/exr_image.h"
#include "recordings/environment/hdr_image.h"
#include "recordings/readers/image_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

namespace inlay {
namespace fs = std::filesystem;
namespace {

std::string lower_extension(const fs::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return extension;
}

ComparedPicture from_linear(Image<Rgb> linear) {
    Image<EncodedRgb> display = encode(linear);
    return {std::move(linear), std::move(display)};
}

ComparedPicture from_display(Image<EncodedRgb> display) {
    Image<Rgb> linear = decode(display);
    return {std::move(linear), std::move(display)};
}

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

Mask finite_in_both(const Image<Rgb>& a, const Image<Rgb>& b) {
    Mask mask(a.width, a.height, 0);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        mask.pixels[i] = finite(a.pixels[i]) && finite(b.pixels[i]) ? 1 : 0;
    return mask;
}

}  // namespace

bool is_picture_name(const fs::path& file) {
    const std::string extension = lower_extension(file);
    for (const char* known : {".png", ".jpg", ".jpeg", ".exr", ".hdr"})
        if (extension == known) return true;
    return false;
}

ComparedPicture read_picture(const fs::path& file) {
    require(fs::exists(file), file.string() + ": there is no such file", ExitCode::input_missing);
    require(is_picture_name(file), file.string() +
                                       ": is no picture that can be compared; expected a name that "
                                       "ends in .png, .jpg, .exr or .hdr");
    const std::string extension = lower_extension(file);
    if (extension == ".exr") return from_linear(read_exr(file));
    if (extension == ".hdr") return from_linear(read_hdr(file));
    return from_display(read_color(file));
}

PictureError picture_error(const ComparedPicture& picture, const ComparedPicture& reference) {
    PictureError error;
    error.radiance = radiance_error(picture.linear, reference.linear);
    error.display = display_error(picture.display, reference.display,
                                  finite_in_both(picture.linear, reference.linear));
    return error;
}

}  // namespace inlay
