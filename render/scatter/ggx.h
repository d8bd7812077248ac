// GGX microfacets in the local frame of a surface (normal = +z), in forms that hold in float.
#pragma once

#include "recordings/base/color.h"
#include "render/sample/warp.h"

#include <glm/glm.hpp>

namespace inlay {

/// GGX reflection times the cosine at the surface (1/sr), with height-correlated Smith masking and
/// Schlick's Fresnel term. Directions are unit and point away from the surface; 0 below it.
Rgb eval_ggx(const Rgb& f0, glm::vec2 alpha, const glm::vec3& viewer, const glm::vec3& light);

/// Reflects `viewer` at a normal drawn from the visible ones (Heitz 2018, "Sampling the GGX
/// Distribution of Visible Normals"). pdf 0 where the reflection points below the surface.
DirectionSample sample_ggx(glm::vec2 alpha, const glm::vec3& viewer, glm::vec2 u);
float pdf_ggx(glm::vec2 alpha, const glm::vec3& viewer, const glm::vec3& light);

}  // namespace inlay
