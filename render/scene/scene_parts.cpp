#include "render/scene/scene_parts.h"

#include "render/scene/texture_files.h"

#include <algorithm>
#include <cmath>

namespace inlay {

namespace {

// Numbers typed with four digits pass; what is no rotation does not.
constexpr double rotation_tolerance = 1e-3;

/// The rotation nearest to columns that are nearly orthonormal (Gram-Schmidt).
glm::dmat3 orthonormal(const glm::dmat3& m) {
    const glm::dvec3 x = glm::normalize(m[0]);
    const glm::dvec3 y = glm::normalize(m[1] - glm::dot(m[1], x) * x);
    return {x, y, glm::cross(x, y)};
}

void require_rotation(const JsonNode& node, const glm::dmat3& m) {
    const glm::dmat3 product = glm::transpose(m) * m;
    double deviation = 0;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            deviation = std::max(deviation, std::abs(product[i][j] - (i == j ? 1 : 0)));
    if (!(deviation <= rotation_tolerance) || !(glm::determinant(m) > 0))
        refuse(node, "a matrix that is no rotation",
               "orthonormal rows and determinant +1 within 0.001");
}

glm::dmat4 affine_of(const JsonNode& node) {
    const std::vector<double> v = numbers_of(node, 16, any_length);
    if (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1)
        refuse(node, "another last row", "0, 0, 0, 1 as the last four numbers (row-major)");
    glm::dmat4 m;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column)
            m[column][row] = v[std::size_t(4 * row + column)];
    return m;
}

Diffuse diffuse_of(const JsonNode& node) {
    require_known_keys(node, {"type", "reflectance", "texture"});
    Diffuse material;
    if (const JsonNode* n = find(node, "reflectance")) material.reflectance = color_of(*n, share);
    return material;
}

Phong phong_of(const JsonNode& node) {
    require_known_keys(node, {"type", "diffuse", "specular", "exponent", "texture"});
    Phong material;
    if (const JsonNode* n = find(node, "diffuse")) material.diffuse = color_of(*n, share);
    if (const JsonNode* n = find(node, "specular")) material.specular = color_of(*n, share);
    if (const JsonNode* n = find(node, "exponent"))
        material.exponent = float(number_of(*n, {1, 1e4}));
    const Rgb sum = material.diffuse + material.specular;
    if (std::max({sum.r, sum.g, sum.b}) > 1 + 1e-6f)
        refuse(node, "diffuse + specular above 1", "a sum of at most 1 in each channel");
    return material;
}

Ggx ggx_of(const JsonNode& node) {
    require_known_keys(node, {"type", "base_color", "roughness", "metallic", "texture"});
    Ggx material;
    if (const JsonNode* n = find(node, "base_color")) material.base_color = color_of(*n, share);
    if (const JsonNode* n = find(node, "metallic")) material.metallic = float(number_of(*n, share));
    if (const JsonNode* n = find(node, "roughness")) {
        if (n->kind == JsonNode::Kind::array) {
            const std::vector<double> v = numbers_of(*n, 2, share);
            material.roughness = {v[0], v[1]};
        } else {
            material.roughness = glm::vec2(float(number_of(*n, share)));
        }
    }
    return material;
}

}  // namespace

glm::dvec3 vector3_of(const JsonNode& node, const Range& range) {
    const std::vector<double> v = numbers_of(node, 3, range);
    return {v[0], v[1], v[2]};
}

Rgb color_of(const JsonNode& node, const Range& range) { return Rgb(vector3_of(node, range)); }

glm::dvec3 direction_of(const JsonNode& node) {
    const glm::dvec3 v = vector3_of(node, any_length);
    if (!(glm::length(v) > 1e-9)) refuse(node, "a vector of length 0", "a direction");
    return glm::normalize(v);
}

glm::dmat3 rotation_of(const JsonNode& node) {
    const std::vector<double> v = numbers_of(node, 9, any_length);
    glm::dmat3 m;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            m[column][row] = v[std::size_t(3 * row + column)];
    require_rotation(node, m);
    return orthonormal(m);
}

Pose pose_of(const JsonNode& node) {
    const glm::dmat4 m = affine_of(node);
    require_rotation(node, glm::dmat3(m));
    return {orthonormal(glm::dmat3(m)), glm::dvec3(m[3])};
}

glm::dmat4 transform_of(const JsonNode& node) {
    const glm::dmat4 m = affine_of(node);
    glm::dmat3 unit(m);
    for (int i = 0; i < 3; ++i) {
        const double scale = glm::length(unit[i]);
        if (!(scale > 1e-9)) refuse(node, "a matrix that flattens", "scales above 0");
        unit[i] /= scale;
    }
    const glm::dmat3 product = glm::transpose(unit) * unit;
    const double shear =
        std::max({std::abs(product[0][1]), std::abs(product[0][2]), std::abs(product[1][2])});
    if (shear > rotation_tolerance || glm::determinant(unit) < 0)
        refuse(node, "a matrix with shear or mirroring",
               "a rotation times scales: three columns at right angles, determinant above 0");
    return m;
}

void require_increasing_times(const std::vector<JsonNode>& items) {
    double last = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const JsonNode& time = member(items[i], "time");
        const double t = number_of(time, any_time);
        if (i > 0 && !(t > last)) refuse(time, describe(time), "a time after the one before it");
        last = t;
    }
}

Material material_of(const JsonNode& node, const AssetFolders& assets) {
    const std::string& type = word_of(member(node, "type"), {"diffuse", "phong", "ggx"});
    Material material;
    if (type == "diffuse") material = diffuse_of(node);
    if (type == "phong") material = phong_of(node);
    if (type == "ggx") material = ggx_of(node);
    if (const JsonNode* n = find(node, "texture")) {
        const auto texture = load_texture(find_asset(assets, text_of(*n), n->place));
        std::visit([&](auto& m) { m.texture = texture; }, material);
    }
    return material;
}

bool textured(const Material& material) {
    return std::visit([](const auto& m) { return m.texture != nullptr; }, material);
}

}  // namespace inlay
