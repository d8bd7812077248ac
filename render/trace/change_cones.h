// ChangeCones: the directions in which virtual geometry can be seen from a surface, and nothing
// else can change the light it receives.
#pragma once

#include "recordings/base/lanes.h"
#include "render/sample/warp.h"
#include "render/trace/bounding_spheres.h"

#include <array>
#include <span>

namespace inlay {

/// Spheres that virtual geometry is held in, at most.
inline constexpr int most_change_cones = 64;

/// Circular cones about the bounding spheres above a surface's horizon, each sampled evenly in
/// solid angle and chosen in proportion to its solid angle times its largest cosine. Spheres that
/// hold or touch a point that the cones are for are seen in the hemisphere, which is sampled with
/// the cosine.
struct ChangeCones {
    int count = 0;         // circular ones
    float hemisphere = 0;  // share of the samples over the hemisphere, 0..1
    glm::vec3 normal{0.0f};
    float fill = 0;  // bound of the share of an even sky's irradiance that comes from them, 0..1
    // Planes, for all cones to be asked at once; up to the next multiple of 8 they hold cones that
    // no direction is in.
    std::array<float, most_change_cones> axis_x, axis_y, axis_z;  // of a unit vector
    std::array<float, most_change_cones> height;   // 1 - cosine of the half angle, 0..1
    std::array<float, most_change_cones> density;  // per steradian, of all samples together
    std::array<float, most_change_cones> below;    // share of the samples in those before

    glm::vec3 middle{0.0f};   // unit: axis of a cone that holds all of them
    float middle_height = 0;  // 1 - cosine of its half angle; 2: every direction may be in one

    bool empty() const { return count == 0 && hemisphere == 0; }
};

/// Sets the cones of `spheres` as seen from all points within `reach` (m, >= 0) of `position`,
/// where rays start, on a surface with the unit normal `normal`. Spheres of which no part may stand
/// above the horizon of such a point, and those that are points seen from all of them, have none.
/// Throws Error for more than most_change_cones of them.
void find_cones(std::span<const BoundingSphere> spheres, const glm::vec3& position,
                const glm::vec3& normal, float reach, ChangeCones& cones);

/// Whether a unit direction can have a density at all: asked first, since most have none.
inline bool may_hold(const ChangeCones& cones, const glm::vec3& direction) {
    const glm::vec3 apart = direction - cones.middle;
    return 0.5f * glm::dot(apart, apart) <= cones.middle_height;
}

/// The same of eight directions.
inline Lanes may_hold(const ChangeCones& cones, const Vectors& directions) {
    const Floats x = directions.x - cones.middle.x, y = directions.y - cones.middle.y,
                 z = directions.z - cones.middle.z;
    return 0.5f * (x * x + y * y + z * z) <= cones.middle_height;
}

/// A direction for `u` in [0, 1) x [0, 1); pdf 0 without cones. It may lie below the horizon.
DirectionSample sample_cones(const ChangeCones& cones, glm::vec2 u);

/// Density (per steradian) with which sample_cones returns a unit direction: a sum over the cones
/// that hold it.
float pdf_cones(const ChangeCones& cones, const glm::vec3& direction);

}  // namespace inlay
