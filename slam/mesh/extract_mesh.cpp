#include "slam/mesh/extract_mesh.h"

#include "recordings/base/parallel.h"
#include "slam/mesh/brick_surface.h"
#include "slam/mesh/weld_surfaces.h"

#include <algorithm>

namespace inlay {
namespace {

constexpr int chunk = 4096;  // vertices

/// Calls body(i) for the vertices of a mesh.
template <class Body>
void for_vertex_indices(const TriangleMesh& mesh, const Body& body) {
    const auto count = int(mesh.positions.size());
    parallel_for((count + chunk - 1) / chunk, [&](int c) {
        for (int i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i)
            body(std::size_t(i));
    });
}

/// Where the field's gradient is not known, the mean of the normals of the triangles around.
void complete_normals(TriangleMesh& mesh) {
    std::vector<char> missing(mesh.positions.size());
    for_vertex_indices(mesh, [&](std::size_t i) {
        missing[i] = !(glm::length(mesh.normals[i]) > 0);
        if (missing[i]) mesh.normals[i] = glm::vec3(0);
    });
    for (const glm::uvec3& t : mesh.triangles) {
        if (!missing[t.x] && !missing[t.y] && !missing[t.z]) continue;
        const glm::vec3& a = mesh.positions[t.x];
        const glm::vec3 area = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int i = 0; i < 3; ++i) {
            if (missing[t[i]]) mesh.normals[t[i]] += area;
        }
    }
    for_vertex_indices(mesh, [&](std::size_t i) {
        const float length = glm::length(mesh.normals[i]);
        mesh.normals[i] = length > 0 ? mesh.normals[i] / length : glm::vec3(0, 0, 1);
    });
}

}  // namespace

TriangleMesh extract_mesh(const VoxelVolume& volume) {
    std::vector<BrickSurface> surfaces(volume.bricks.size());
    parallel_for(int(surfaces.size()), [&](int i) {
        surfaces[std::size_t(i)] = brick_surface(volume, volume.bricks[std::size_t(i)]);
    });
    TriangleMesh mesh = weld_surfaces(surfaces);
    complete_normals(mesh);
    for_vertex_indices(mesh, [&](std::size_t i) { mesh.positions[i] *= volume.voxel_size; });
    return mesh;
}

}  // namespace inlay
