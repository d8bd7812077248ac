#include "slam/mesh/weld_vertices.h"

#include <unordered_map>

namespace inlay {
namespace {

struct EdgeHash {
    std::size_t operator()(const glm::ivec3& e) const {
        const auto part = [](int i) { return std::size_t(std::uint32_t(i)); };
        std::size_t x = (part(e.x) * 0x9e3779b97f4a7c15U) ^ (part(e.y) * 0xc2b2ae3d27d4eb4fU) ^
                        (part(e.z) * 0x165667b19e3779f9U);
        return x ^ (x >> 29);
    }
};

}  // namespace

WeldedTriangles weld_vertices(std::span<const EdgeCorner> soup) {
    WeldedTriangles welded;
    std::unordered_map<glm::ivec3, unsigned, EdgeHash> vertex_of;
    vertex_of.reserve(soup.size() / 4);
    const auto vertex = [&](const EdgeCorner& corner) {
        const auto [entry, is_new] =
            vertex_of.try_emplace(corner.edge, unsigned(welded.positions.size()));
        if (is_new) welded.positions.push_back(corner.position);
        return entry->second;
    };
    welded.triangles.reserve(soup.size() / 3);
    for (std::size_t i = 0; i + 2 < soup.size(); i += 3) {
        const unsigned a = vertex(soup[i]), b = vertex(soup[i + 1]), c = vertex(soup[i + 2]);
        welded.triangles.emplace_back(a, b, c);
    }
    return welded;
}

}  // namespace inlay
