// Square -> hemisphere and lobe: each warp with its density and its inverse.
#pragma once

#include <glm/glm.hpp>

namespace inlay {

struct DirectionSample {
    glm::vec3 direction;  // unit
    float pdf = 0;        // per steradian
};

/// Directions about +z with density cos / pi. `u` in [0, 1) x [0, 1).
DirectionSample sample_cosine_hemisphere(glm::vec2 u);
float pdf_cosine_hemisphere(const glm::vec3& direction);
glm::vec2 invert_cosine_hemisphere(const glm::vec3& direction);

/// Directions about +z with density (n + 1) / (2 pi) cos^n, n = `exponent` >= 0.
DirectionSample sample_cosine_power(glm::vec2 u, float exponent);
float pdf_cosine_power(const glm::vec3& direction, float exponent);
glm::vec2 invert_cosine_power(const glm::vec3& direction, float exponent);

/// An orthonormal, right-handed basis whose third column is the unit vector `z` (Duff et al. 2017,
/// "Building an Orthonormal Basis, Revisited"): a rotation from the local frame of a warp.
glm::mat3 basis_about(const glm::vec3& z);

}  // namespace inlay
