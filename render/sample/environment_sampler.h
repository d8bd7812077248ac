// EnvironmentSampler: directions drawn in proportion to the luminance an environment map sends.
#pragma once

#include "recordings/base/environment_map.h"
#include "render/sample/discrete_table.h"

#include <glm/glm.hpp>

#include <memory>
#include <vector>

namespace inlay {

struct LightSample {
    glm::vec3 direction;  // unit, world, towards the light
    Rgb radiance{0.0f};
    float pdf = 0;  // per steradian; 0: nothing was sampled
};

/// A map with its sampling tables: rows by luminance times solid angle, then texels within the row.
/// Within a texel directions are uniform in solid angle, so that radiance / pdf is constant there.
struct EnvironmentSampler {
    EnvironmentMap map;
    DiscreteTable rows;
    std::vector<DiscreteTable> texels;  // one per row
    std::vector<double> row_cosines;    // of the polar angles between rows, height + 1 of them
    float mean_luminance = 0;           // over the sphere
};

/// Throws Error for an empty map or for texels that are not finite and >= 0. A black map is sampled
/// evenly over the sphere.
EnvironmentSampler make_environment_sampler(EnvironmentMap map);

LightSample sample_environment(const EnvironmentSampler& sampler, glm::vec2 u);

/// Density (per steradian) with which sample_environment returns a unit direction (world).
float pdf_environment(const EnvironmentSampler& sampler, const glm::vec3& direction);

}  // namespace inlay
