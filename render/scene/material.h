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
    bool vertex_colors = false;                   // so do the mesh's own colors
};

/// Lambertian plus a cosine-power lobe about the mirror direction (Mehta 2015, sec. 6.6.3):
/// f = diffuse / pi + specular (n + 2) / (2 pi) max(0, cos(mirror, w))^n. diffuse + specular <= 1.
struct Phong {
    Rgb diffuse{0.0f};                            // 0..1
    Rgb specular{0.5f};                           // 0..1
    float exponent = 64.0f;                       // n, 1..1e4
    std::shared_ptr<const Texture> texture = {};  // optional; multiplies `diffuse`
};

/// Metal and plastic as in glTF 2.0: a GGX reflection over a Lambertian base.
/// alpha = roughness^2; reflectance at normal incidence 0.04 for a dielectric, base_color for a
/// metal.
struct Ggx {
    Rgb base_color{0.5f};                         // 0..1
    glm::vec2 roughness{0.5f};                    // along the two tangents, 0..1
    float metallic = 0.0f;                        // 0..1
    std::shared_ptr<const Texture> texture = {};  // optional; multiplies `base_color`
};

using Material = std::variant<Diffuse, Phong, Ggx>;

}  // namespace inlay
