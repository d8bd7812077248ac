#include "render/scene/mesh_checks.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace inlay {

namespace {

template <class Vector>
void require_finite(const std::vector<Vector>& values, const char* name, const std::string& place) {
    for (std::size_t i = 0; i < values.size(); ++i) {
        for (int c = 0; c < Vector::length(); ++c) {
            require(std::isfinite(values[i][c]) && std::abs(values[i][c]) < 1e15f,
                    place + ": " + name + " " + std::to_string(i) +
                        " is not a finite number of ordinary size; repair the mesh");
        }
    }
}

void require_length(std::size_t found, std::size_t expected, const char* name,
                    const std::string& place) {
    require(found == 0 || found == expected, place + ": " + std::to_string(found) + " " + name +
                                                 " for " + std::to_string(expected) +
                                                 " positions; expected as many");
}

glm::dvec3 twice_area(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    return glm::cross(b - a, c - a);
}

bool degenerate(const TriangleMesh& mesh, const glm::uvec3& t) {
    const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
    const double longest =
        std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
    return !(glm::length(twice_area(mesh, t)) > 1e-7 * longest);
}

}  // namespace

void validate(const TriangleMesh& mesh, const std::string& place) {
    const std::size_t count = mesh.positions.size();
    require_finite(mesh.positions, "vertex", place);
    require_finite(mesh.normals, "normal", place);
    require_finite(mesh.texture_coordinates, "texture coordinate", place);
    require_length(mesh.normals.size(), count, "normals", place);
    require_length(mesh.texture_coordinates.size(), count, "texture coordinates", place);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        require(std::max({t.x, t.y, t.z}) < count,
                place + ": triangle " + std::to_string(i) + " refers to vertex " +
                    std::to_string(std::max({t.x, t.y, t.z})) + "; expected less than " +
                    std::to_string(count));
    }
}

int drop_degenerate_triangles(TriangleMesh& mesh) {
    return int(
        std::erase_if(mesh.triangles, [&](const glm::uvec3& t) { return degenerate(mesh, t); }));
}

std::vector<glm::vec3> smooth_normals(const TriangleMesh& mesh) {
    const auto key = [&](unsigned i) {
        const glm::vec3 p = mesh.positions[i] + 0.0f;  // -0 becomes 0
        return std::array<float, 3>{p.x, p.y, p.z};
    };
    std::map<std::array<float, 3>, glm::dvec3> sums;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 weighted = twice_area(mesh, t);
        for (int corner = 0; corner < 3; ++corner)
            sums.try_emplace(key(t[corner]), 0.0).first->second += weighted;
    }
    std::vector<glm::vec3> normals(mesh.positions.size(), glm::vec3(0, 1, 0));
    for (unsigned i = 0; i < normals.size(); ++i) {
        const auto sum = sums.find(key(i));
        if (sum == sums.end()) continue;
        const double length = glm::length(sum->second);
        if (length > 0) normals[i] = glm::vec3(sum->second / length);
    }
    return normals;
}

void complete_normals(TriangleMesh& mesh) {
    if (mesh.normals.empty()) {
        mesh.normals = smooth_normals(mesh);
        return;
    }
    std::vector<glm::vec3> smooth;
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const double length = glm::length(glm::dvec3(mesh.normals[i]));
        if (length > 0) {
            mesh.normals[i] = glm::vec3(glm::dvec3(mesh.normals[i]) / length);
            continue;
        }
        if (smooth.empty()) smooth = smooth_normals(mesh);
        mesh.normals[i] = smooth[i];
    }
}

}  // namespace inlay
