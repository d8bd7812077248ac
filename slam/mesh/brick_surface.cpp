#include "slam/mesh/brick_surface.h"

#include "slam/mesh/brick_field.h"

#include <pcl/surface/marching_cubes.h>  // its tables

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <utility>

namespace inlay {
namespace {

constexpr float least_distance = 1e-4f;  // of the truncation; keeps vertices off lattice points

/// The corners of a cell in PCL's order.
constexpr std::array<glm::ivec3, 8> cell_corners{glm::ivec3(0, 0, 0), {1, 0, 0}, {1, 0, 1},
                                                 {0, 0, 1},           {0, 1, 0}, {1, 1, 0},
                                                 {1, 1, 1},           {0, 1, 1}};

/// Slots in a table of the edges of a brick's cells: three from each of 9 x 9 x 9 voxels.
constexpr glm::ivec3 edge_stride{3, 27, 243};
constexpr std::size_t brick_edges = 2187;

/// An edge of a cell, in the direction in which PCL interpolates.
struct CellEdge {
    std::size_t from, to;  // corners
    int axis;

    /// Its slot less that of the cell.
    constexpr int slot() const {
        const glm::ivec3 &a = cell_corners[from], &b = cell_corners[to];
        return std::min(a.x, b.x) * edge_stride.x + std::min(a.y, b.y) * edge_stride.y +
               std::min(a.z, b.z) * edge_stride.z + axis;
    }
};

constexpr std::array<CellEdge, 12> cell_edges{{{0, 1, 0},
                                               {1, 2, 2},
                                               {2, 3, 0},
                                               {3, 0, 2},
                                               {4, 5, 0},
                                               {5, 6, 2},
                                               {6, 7, 0},
                                               {7, 4, 2},
                                               {0, 4, 1},
                                               {1, 5, 1},
                                               {2, 6, 1},
                                               {3, 7, 1}}};

constexpr std::array<int, 12> edge_slots = [] {
    std::array<int, 12> slots{};
    for (std::size_t i = 0; i < slots.size(); ++i)
        slots[i] = cell_edges[i].slot();
    return slots;
}();

/// The distance at a point whose coordinates are whole but for that along `axis`: trilinear as
/// VolumeSampler's, of which the terms that are not 0 remain.
inline float distance_on_line(const BrickField& field, const glm::vec3& p, int axis) {
    const glm::vec3 base = glm::floor(p);
    const std::size_t entry = field.entry(glm::ivec3(base));
    if (!(field.cell[entry] & cell_known)) return unknown_distance;
    const float f = p[axis] - base[axis];
    const float ahead = field.distance[entry + std::size_t(BrickField::stride[std::size_t(axis)])];
    return 0.0f + (1 - f) * field.distance[entry] + f * ahead;  // the first 0 makes 0 of -0
}

/// The surface of a brick as it grows.
struct Growing {
    const BrickField& field;
    BrickSurface surface;
    std::array<std::uint16_t, brick_edges> vertex_on{};  // one more than its index, or 0
};

/// A cell and the distances at its corners.
struct CrossedCell {
    glm::ivec3 at{0};  // in the brick
    int slot = 0;      // of its first edge
    std::array<float, 8> values{};
};

CrossedCell read_cell(const BrickField& field, const glm::ivec3& at) {
    const glm::ivec3 slots = at * edge_stride;
    CrossedCell cell{.at = at, .slot = slots.x + slots.y + slots.z};
    const std::size_t entry = field.entry(field.first + 1 + at);
    for (std::size_t c = 0; c < cell_corners.size(); ++c) {
        const glm::ivec3& to = cell_corners[c];
        const int further = to.x + to.y * BrickField::stride[1] + to.z * BrickField::stride[2];
        const float d = field.distance[entry + std::size_t(further)];
        cell.values[c] =
            std::abs(d) < least_distance ? (d < 0 ? -least_distance : least_distance) : d;
    }
    return cell;
}

EdgeVertex make_vertex(const BrickField& field, const CrossedCell& cell, const CellEdge& edge) {
    const glm::ivec3 from = cell.at + cell_corners[edge.from], to = cell.at + cell_corners[edge.to];
    const glm::ivec3 first = field.first + 1;  // of the brick
    const float value = cell.values[edge.from];
    const float share = (0 - value) / (cell.values[edge.to] - value);
    const glm::vec3 in_brick = glm::vec3(from) + share * glm::vec3(to - from);
    EdgeVertex vertex{.edge = 2 * first + from + to, .position = glm::vec3(first) + in_brick};
    const auto distance = [&](const glm::vec3& p) { return distance_on_line(field, p, edge.axis); };
    vertex.normal = field_gradient(distance, vertex.position);
    const glm::vec3 base = glm::floor(vertex.position);
    vertex.color =
        mixed_color(field.places(glm::ivec3(base)), vertex.position - base).value_or(Rgb(0));
    return vertex;
}

/// The index of the vertex on an edge of a cell, which is made if it is not there.
unsigned vertex_on(Growing& growing, const CrossedCell& cell, std::size_t edge) {
    const int slot = cell.slot + edge_slots[edge];
    std::uint16_t& number = growing.vertex_on[std::size_t(slot)];
    if (number == 0) {
        growing.surface.vertices.push_back(make_vertex(growing.field, cell, cell_edges[edge]));
        number = std::uint16_t(growing.surface.vertices.size());
    }
    return number - 1U;
}

void add_triangles(Growing& growing, const glm::ivec3& at) {
    const CrossedCell cell = read_cell(growing.field, at);
    unsigned inside = 0;
    for (std::size_t c = 0; c < cell.values.size(); ++c)
        inside |= (cell.values[c] < 0 ? 1U : 0U) << c;
    const auto vertex = [&](int edge) { return vertex_on(growing, cell, std::size_t(edge)); };
    for (const int* edge = pcl::triTable[inside]; *edge != -1; edge += 3) {
        const unsigned a = vertex(edge[0]), b = vertex(edge[1]), c = vertex(edge[2]);
        growing.surface.triangles.emplace_back(a, b, c);
    }
}

}  // namespace

BrickSurface brick_surface(const VoxelVolume& volume, const Brick& brick) {
    const BrickField field = brick_field(volume, brick);
    Growing growing{.field = field, .surface = {}};
    for (int k = 0; k < brick_side; ++k) {
        for (int j = 0; j < brick_side; ++j) {
            const std::uint8_t* row =
                &field.cell[field.entry(field.first + 1 + glm::ivec3(0, j, k))];
            std::uint64_t eight = 0;  // nearly always none is crossed
            static_assert(sizeof(eight) == brick_side);
            std::memcpy(&eight, row, sizeof(eight));
            if (!(eight & (0x0101010101010101U * cell_crossed))) continue;
            for (int i = 0; i < brick_side; ++i) {
                if (row[i] & cell_crossed) add_triangles(growing, {i, j, k});
            }
        }
    }
    return std::move(growing.surface);
}

}  // namespace inlay
