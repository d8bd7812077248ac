// The surfaces of bricks -> one mesh with shared vertices.
#pragma once

#include "recordings/base/triangle_mesh.h"
#include "slam/mesh/brick_surface.h"

#include <span>

namespace inlay {

/// Makes one vertex of all on the same edge, that of the first surface that has it, in the order of
/// first use. Positions, normals and colors stay as they are.
TriangleMesh weld_surfaces(std::span<const BrickSurface> surfaces);

}  // namespace inlay
