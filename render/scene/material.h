// Material: what a virtual surface does to light.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"

#include <memory>
#include <variant>

namespace inlay {

/// A picture that multiplies a material's diffuse reflectance, linear, 0..1; row 0 is the top.
using Texture = Image<Rgb>;

/// Lambertian: reflects the share `reflectance` evenly into the hemisphere.
struct Diffuse {
    Rgb reflectance{0.5f};                        // 0..1
    std::shared_ptr<const Texture> texture = {};  // optional; multiplies `reflectance`
};

/// Lambertian plus a cosine-power lobe about the mirror direction (Mehta 2015, sec. 6.6.3):
/// f = diffuse / pi + specular (n + 2) / (2 pi) max(0, cos(mirror, w))^n. diffuse + specular <= 1.
struct Phong {
    Rgb diffuse{0.0f};                            // 0..1
    Rgb specular{0.5f};                           // 0..1
    float exponent = 64.0f;                       // n, 1..1e4
    std::shared_ptr<const Texture> texture = {};  // optional; multiplies `diffuse`
};

using Material = std::variant<Diffuse, Phong>;

}  // namespace inlay
