#include "slam/mesh/weld_surfaces.h"

#include "recordings/base/parallel.h"

#include <bit>

namespace inlay {
namespace {

/// From an edge to the number of its vertex, by open addressing; not for more than `most` edges.
class EdgeNumbers {
public:
    explicit EdgeNumbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 1)) {}

    /// The number stored for an edge, which is `number` if it is new.
    unsigned number_of(const glm::ivec3& edge, unsigned number) {
        std::size_t at = hash(edge) & (slots_.size() - 1);
        while (slots_[at].used && slots_[at].edge != edge)
            at = (at + 1) & (slots_.size() - 1);
        if (!slots_[at].used) slots_[at] = {edge, true, number};
        return slots_[at].number;
    }

private:
    struct Slot {
        glm::ivec3 edge{0};
        bool used = false;
        unsigned number = 0;
    };
    static std::size_t hash(const glm::ivec3& e) {
        const auto part = [](int i) { return std::size_t(std::uint32_t(i)); };
        const std::size_t x = (part(e.x) * 0x9e3779b97f4a7c15U) ^
                              (part(e.y) * 0xc2b2ae3d27d4eb4fU) ^ (part(e.z) * 0x165667b19e3779f9U);
        return x ^ (x >> 29);
    }

    std::vector<Slot> slots_;
};

/// Whether cells of several bricks have the edge: it lies in a plane between bricks.
bool between_bricks(const glm::ivec3& edge) {
    constexpr int last = 2 * brick_side - 1;
    return (edge.x & last) == 0 || (edge.y & last) == 0 || (edge.z & last) == 0;
}

/// Where the parts of a surface go in the mesh.
struct Places {
    std::vector<unsigned> vertices;  // the mesh's vertex for each of the surface's
    unsigned first_new = 0;          // vertices from here on are the surface's own
    std::size_t first_triangle = 0;
};

struct Numbering {
    std::vector<Places> places;
    unsigned vertices = 0;
    std::size_t triangles = 0;
};

Numbering number_vertices(std::span<const BrickSurface> surfaces) {
    Numbering numbering;
    numbering.places.resize(surfaces.size());
    std::size_t shared_vertices = 0;
    for (const BrickSurface& surface : surfaces) {
        for (const EdgeVertex& vertex : surface.vertices)
            shared_vertices += between_bricks(vertex.edge) ? 1 : 0;
    }
    EdgeNumbers shared(shared_vertices);
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        Places& places = numbering.places[i];
        places.first_new = numbering.vertices;
        places.first_triangle = numbering.triangles;
        places.vertices.reserve(surfaces[i].vertices.size());
        for (const EdgeVertex& vertex : surfaces[i].vertices) {
            unsigned number = numbering.vertices;
            if (between_bricks(vertex.edge)) number = shared.number_of(vertex.edge, number);
            if (number == numbering.vertices) ++numbering.vertices;
            places.vertices.push_back(number);
        }
        numbering.triangles += surfaces[i].triangles.size();
    }
    return numbering;
}

void put(const BrickSurface& surface, const Places& places, TriangleMesh& mesh) {
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const std::size_t to = places.vertices[i];
        if (to < places.first_new) continue;
        mesh.positions[to] = surface.vertices[i].position;
        mesh.normals[to] = surface.vertices[i].normal;
        mesh.colors[to] = surface.vertices[i].color;
    }
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
        const glm::uvec3& t = surface.triangles[i];
        mesh.triangles[places.first_triangle + i] = {places.vertices[t.x], places.vertices[t.y],
                                                     places.vertices[t.z]};
    }
}

}  // namespace

TriangleMesh weld_surfaces(std::span<const BrickSurface> surfaces) {
    const Numbering numbering = number_vertices(surfaces);
    TriangleMesh mesh;
    mesh.positions.resize(numbering.vertices);
    mesh.normals.resize(numbering.vertices);
    mesh.colors.resize(numbering.vertices);
    mesh.triangles.resize(numbering.triangles);
    parallel_for(int(surfaces.size()), [&](int i) {
        put(surfaces[std::size_t(i)], numbering.places[std::size_t(i)], mesh);
    });
    return mesh;
}

}  // namespace inlay
