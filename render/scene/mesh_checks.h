// Checks and repairs of triangle meshes as files bring them.
#pragma once

#include "recordings/base/triangle_mesh.h"

#include <string>

namespace inlay {

/// Throws Error (bad_data) with `place` in the message unless indices are in range, attributes are
/// empty or as many as positions, and all values are finite.
void validate(const TriangleMesh& mesh, const std::string& place);

/// Removes triangles without area (m^2; below float precision of their longest edge) and returns
/// how many.
int drop_degenerate_triangles(TriangleMesh& mesh);

/// Normals averaged over the triangles that meet at a position, weighted by area; vertices at the
/// same position (texture seams) share theirs. A vertex without triangles gets +y.
std::vector<glm::vec3> smooth_normals(const TriangleMesh& mesh);

/// Makes given normals unit; where one is zero, the smooth normal takes its place.
void complete_normals(TriangleMesh& mesh);

}  // namespace inlay
