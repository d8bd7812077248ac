// EnvironmentSampler: directions drawn in proportion to the luminance an environment map sends.
#pragma once

#include "recordings/base/environment_map.h"
#include "render/sample/discrete_table.h"

#include <glm/glm.hpp>

#include <cstdint>
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
    std::vector<LightSample> list;      // the only samples there are; empty: drawn from the tables
    std::uint64_t fingerprint = 0;      // of map and list: another light has another
};

/// Throws Error for an empty map or for texels that are not finite and >= 0. A black map is sampled
/// evenly over the sphere.
EnvironmentSampler make_environment_sampler(EnvironmentMap map);

/// A sampler that only ever returns `length` (> 0) samples, drawn once from the map's tables with
/// `seed`, each equally likely: Mehta 2015's list of light samples (an array to look up on a GPU).
/// Sample i has its first number in the i-th part of [0, 1), so that stratified numbers keep their
/// order. Estimates are right on average over seeds, but every frame and pixel shares the error of
/// one list, which more samples per pixel do not lower: it falls as 1 / sqrt(length) or better.
/// pdf_environment stays that of the tables. Throws Error as make_environment_sampler does, and
/// where length is not positive.
EnvironmentSampler make_light_list(EnvironmentMap map, int length, std::uint32_t seed);

LightSample sample_environment(const EnvironmentSampler& sampler, glm::vec2 u);

/// The sample of a unit direction (world) as sample_environment would have returned it: one look-up
/// for the radiance and the density. The density is 0 where nothing can be drawn.
LightSample sample_along(const EnvironmentSampler& sampler, const glm::vec3& direction);

/// Density (per steradian) with which sample_environment returns a unit direction (world).
float pdf_environment(const EnvironmentSampler& sampler, const glm::vec3& direction);

}  // namespace inlay
