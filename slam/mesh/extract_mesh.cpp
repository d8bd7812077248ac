#include "slam/mesh/extract_mesh.h"

#include "recordings/base/parallel.h"
#include "slam/mesh/weld_vertices.h"
#include "slam/volume/sample_volume.h"

#include <pcl/common/common.h>
#include <pcl/point_types.h>
#include <pcl/surface/impl/marching_cubes.hpp>
#include <pcl/surface/marching_cubes.h>

#include <array>
#include <cmath>

namespace inlay {
namespace {

constexpr float least_distance = 1e-4f;  // of the truncation; keeps corners off lattice points

/// PCL's marching cubes, one cell at a time, in voxels from the first voxel of a brick. Its own
/// loop wants a dense grid and leaves out the outermost cells; its cells alone need neither.
class CellTriangles : public pcl::MarchingCubes<pcl::PointXYZ> {
public:
    CellTriangles() {
        lower_boundary_ = Eigen::Array3f::Zero();
        size_voxel_ = Eigen::Array3f::Ones();
    }
    /// Adds the triangles of the cell at `cell`; `values` in PCL's order of corners.
    void add(const std::vector<float>& values, const glm::ivec3& cell,
             pcl::PointCloud<pcl::PointXYZ>& soup) {
        createSurface(values, Eigen::Vector3i(cell.x, cell.y, cell.z), soup);
    }

private:
    void voxelizeData() override {}
};

/// The corners of a cell in PCL's order.
const std::array<glm::ivec3, 8> cell_corners{glm::ivec3(0, 0, 0), {1, 0, 0}, {1, 0, 1}, {0, 0, 1},
                                             {0, 1, 0},           {1, 1, 0}, {1, 1, 1}, {0, 1, 1}};

/// A brick's voxels and the first of its neighbours: distances, unknown_distance where not seen.
using BrickDistances = std::array<float, 9 * 9 * 9>;

BrickDistances read_distances(VolumeSampler& sampler, const Brick& brick) {
    BrickDistances distances{};
    std::size_t entry = 0;
    for (int k = 0; k <= brick_side; ++k) {
        for (int j = 0; j <= brick_side; ++j) {
            for (int i = 0; i <= brick_side; ++i, ++entry) {
                const glm::ivec3 voxel = brick.key * brick_side + glm::ivec3(i, j, k);
                distances[entry] = sampler.voxel(voxel).distance();
            }
        }
    }
    return distances;
}

/// Reads a cell; false where the surface does not pass or a corner is not known.
bool read_cell(const BrickDistances& distances, const glm::ivec3& cell,
               std::vector<float>& values) {
    int inside = 0;
    for (std::size_t c = 0; c < cell_corners.size(); ++c) {
        const glm::ivec3 at = cell + cell_corners[c];
        const int corner = (at.z * 9 + at.y) * 9 + at.x;
        const float d = distances[std::size_t(corner)];
        if (!is_known(d)) return false;
        values[c] = std::abs(d) < least_distance ? (d < 0 ? -least_distance : least_distance) : d;
        inside += d < 0;
    }
    return inside > 0 && inside < 8;
}

/// The name of the lattice edge a corner lies on; exact, since no corner is a lattice point.
glm::ivec3 edge_of(const pcl::PointXYZ& corner, const Brick& brick) {
    const auto doubled = [](float x) {
        const float whole = std::floor(x);
        return 2 * int(whole) + (x > whole ? 1 : 0);
    };
    return 2 * brick_side * brick.key +
           glm::ivec3(doubled(corner.x), doubled(corner.y), doubled(corner.z));
}

std::vector<EdgeCorner> brick_triangles(const VoxelVolume& volume, const Brick& brick) {
    VolumeSampler sampler(volume);
    const BrickDistances distances = read_distances(sampler, brick);
    CellTriangles cubes;
    pcl::PointCloud<pcl::PointXYZ> soup;
    std::vector<float> values(8);
    for (int k = 0; k < brick_side; ++k) {
        for (int j = 0; j < brick_side; ++j) {
            for (int i = 0; i < brick_side; ++i) {
                if (read_cell(distances, {i, j, k}, values)) cubes.add(values, {i, j, k}, soup);
            }
        }
    }
    std::vector<EdgeCorner> corners;
    corners.reserve(soup.size());
    for (const pcl::PointXYZ& p : soup) {
        const glm::vec3 position(brick.key * brick_side);
        corners.push_back({edge_of(p, brick), position + glm::vec3(p.x, p.y, p.z)});
    }
    return corners;
}

void add_attributes(TriangleMesh& mesh, const VoxelVolume& volume) {
    constexpr int chunk = 4096;  // vertices
    const int count = int(mesh.positions.size());
    mesh.normals.assign(std::size_t(count), glm::vec3(0));
    mesh.colors.assign(std::size_t(count), glm::vec3(0));
    parallel_for((count + chunk - 1) / chunk, [&](int c) {
        VolumeSampler sampler(volume);
        for (int i = c * chunk; i < std::min(count, (c + 1) * chunk); ++i) {
            const auto vertex = std::size_t(i);
            const glm::vec3& p = mesh.positions[vertex];  // still in voxels
            mesh.normals[vertex] = sampler.gradient(p);
            mesh.colors[vertex] = volume_color(sampler, p).value_or(Rgb(0));
        }
    });
}

/// Where the field's gradient is not known, the mean of the normals of the triangles around.
void complete_normals(TriangleMesh& mesh) {
    std::vector<glm::vec3> around(mesh.positions.size(), glm::vec3(0));
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3& a = mesh.positions[t.x];
        const glm::vec3 area = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a);
        for (int i = 0; i < 3; ++i)
            around[t[i]] += area;
    }
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const glm::vec3 n = glm::length(mesh.normals[i]) > 0 ? mesh.normals[i] : around[i];
        const float length = glm::length(n);
        mesh.normals[i] = length > 0 ? n / length : glm::vec3(0, 0, 1);
    }
}

}  // namespace

TriangleMesh extract_mesh(const VoxelVolume& volume) {
    std::vector<std::vector<EdgeCorner>> bricks(volume.bricks.size());
    parallel_for(int(bricks.size()), [&](int i) {
        bricks[std::size_t(i)] = brick_triangles(volume, volume.bricks[std::size_t(i)]);
    });
    std::vector<EdgeCorner> soup;
    for (const auto& brick : bricks)
        soup.insert(soup.end(), brick.begin(), brick.end());
    WeldedTriangles welded = weld_vertices(soup);
    TriangleMesh mesh;
    mesh.positions = std::move(welded.positions);
    mesh.triangles = std::move(welded.triangles);
    add_attributes(mesh, volume);
    complete_normals(mesh);
    for (glm::vec3& p : mesh.positions)
        p *= volume.voxel_size;
    return mesh;
}

}  // namespace inlay
