// Linear pictures and named layers as OpenEXR files that compositing programs understand.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/pose.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace inlay {

/// The channels of a layer called `name`, and their type in the file.
enum class ExrLayerKind {
    color,   // name.R, name.G, name.B: half, clamped to +-65504
    vector,  // name.X, name.Y, name.Z: float
    value    // name: float
};

/// One layer; the image is the caller's and must outlive the writing.
struct ExrLayer {
    std::string name;  // letters, digits and '_', a letter first; not R, G, B or A
    ExrLayerKind kind = ExrLayerKind::color;
    std::variant<const Image<glm::vec3>*, const Image<float>*> image;
};

ExrLayer color_layer(std::string name, const Image<Rgb>& image);
ExrLayer vector_layer(std::string name, const Image<glm::vec3>& image);
ExrLayer value_layer(std::string name, const Image<float>& image);

enum class ExrPrecision { half_float, full_float };

/// What one file holds: the picture itself (channels R, G, B; none when null) and its layers.
struct ExrFile {
    const Image<Rgb>* picture = nullptr;
    ExrPrecision picture_precision = ExrPrecision::half_float;
    std::vector<ExrLayer> layers{};
    std::optional<int> frame{};               // attribute inlay/frame
    std::optional<Pose> world_from_camera{};  // attribute inlay/worldFromCamera, column vectors, m
    Rgb exposure{1};  // attribute inlay/exposure, unless 1: the photograph is so much brighter
};

/// The file in memory: one part, scan lines, ZIP, Rec. 709 chromaticities, no dates, so that equal
/// pixels give equal bytes. Throws Error (bad_data) naming the layer and pixel for a value that is
/// not finite, and for names and sizes that clash.
std::vector<std::byte> encode_exr(const ExrFile& contents);

/// Writes the file; throws Error as encode_exr and write_file do.
void write_exr(const std::filesystem::path& file, const ExrFile& contents);

}  // namespace inlay
