// The up direction of a scene whose recording does not give it.
#pragma once

#include "recordings/base/surface_map.h"

#include <glm/glm.hpp>

#include <optional>

namespace inlay {

/// Unit up direction (world) from the largest set of surfaces that face the same way within 10
/// degrees and whose normal is within 60 degrees of the image's upward direction: table, floor.
/// Empty where less than a twentieth of the measured pixels agree. Assumes a camera that is held
/// roughly upright.
std::optional<glm::dvec3> measure_up(const SurfaceMap& surface);

}  // namespace inlay
