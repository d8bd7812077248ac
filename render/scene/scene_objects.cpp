#include "recordings/base/check.h"
#include "render/scene/mesh_files.h"
#include "render/scene/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace inlay {

namespace {

struct Box {
    glm::dvec3 least{std::numeric_limits<double>::infinity()};
    glm::dvec3 greatest{-std::numeric_limits<double>::infinity()};
};

template <class Change>
void for_each_mesh(LoadedMesh& loaded, const Change& change) {
    for (LoadedPart& part : loaded.parts)
        change(part.mesh);
}

/// (x, y, z) -> (x, z, -y): turns z-up to y-up.
void stand_up(TriangleMesh& mesh) {
    const auto turn = [](glm::vec3& v) { v = {v.x, v.z, -v.y}; };
    std::for_each(mesh.positions.begin(), mesh.positions.end(), turn);
    std::for_each(mesh.normals.begin(), mesh.normals.end(), turn);
}

Box bounds(const LoadedMesh& loaded) {
    Box box;
    for (const LoadedPart& part : loaded.parts) {
        for (const glm::uvec3& t : part.mesh.triangles) {
            for (int corner = 0; corner < 3; ++corner) {
                const glm::dvec3 p(part.mesh.positions[t[corner]]);
                box = {glm::min(box.least, p), glm::max(box.greatest, p)};
            }
        }
    }
    return box;
}

/// The factor from file units to m that `scale` or `height` asks for.
double scale_of(const JsonNode& node, const LoadedMesh& loaded) {
    const JsonNode* scale = find(node, "scale");
    const JsonNode* height = find(node, "height");
    if (scale && height) refuse(*height, "both \"scale\" and \"height\"", "one of them");
    if (scale) return number_of(*scale, {1e-6, 1e6});
    if (!height) return 1;
    const Box box = bounds(loaded);
    const double file_height = box.greatest.y - box.least.y;
    if (!(file_height > 1e-12)) refuse(*height, "a height for a flat mesh", "\"scale\" instead");
    return number_of(*height, {1e-4, 1e4}) / file_height;
}

glm::dmat4 translation(const glm::dvec3& t) {
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(t, 1);
    return m;
}

void read_mesh(SceneEntry& entry, std::vector<std::string>& warnings, const JsonNode& node,
               const AssetFolders& assets) {
    const JsonNode& name = member(node, "mesh");
    const JsonNode* material = find(node, "material");
    LoadedMesh loaded = load_mesh(find_asset(assets, text_of(name), name.place), assets,
                                  material ? MeshMaterials::ignore : MeshMaterials::read);
    warnings.insert(warnings.end(), loaded.warnings.begin(), loaded.warnings.end());
    if (const JsonNode* axis = find(node, "up_axis"))
        if (word_of(*axis, {"y", "z"}) == "z") for_each_mesh(loaded, stand_up);
    const double scale = scale_of(node, loaded);
    for_each_mesh(loaded, [&](TriangleMesh& mesh) {
        for (glm::vec3& p : mesh.positions)
            p = glm::vec3(glm::dvec3(p) * scale);
    });
    const Box box = bounds(loaded);
    const glm::dvec3 middle = 0.5 * (box.least + box.greatest);
    entry.base_from_object = translation({-middle.x, -box.least.y, -middle.z});
    const Material given = material ? material_of(*material, assets) : Material{};
    for (LoadedPart& part : loaded.parts) {
        const Material chosen = material ? given : part.material.value_or(Diffuse{});
        if (textured(chosen) && part.mesh.texture_coordinates.empty())
            refuse(name, "a texture on a mesh without texture coordinates",
                   "a mesh with them, or a material without \"texture\"");
        entry.object.parts.push_back(
            {MeshShape{std::make_shared<const TriangleMesh>(std::move(part.mesh))}, chosen});
    }
}

void read_sphere(SceneEntry& entry, const JsonNode& node, const AssetFolders& assets) {
    const JsonNode& sphere = member(node, "sphere");
    require_known_keys(sphere, {"radius"});
    const double radius = number_of(member(sphere, "radius"), {1e-4, 1e4});
    for (const char* key : {"scale", "height", "up_axis"})
        if (const JsonNode* n = find(node, key))
            refuse(*n, "\"" + std::string(key) + "\" on a sphere", "the size as its \"radius\"");
    Material material;
    if (const JsonNode* n = find(node, "material")) material = material_of(*n, assets);
    entry.base_from_object = translation({0, radius, 0});
    entry.object.parts.push_back({SphereShape{float(radius)}, material});
}

Placement placement_of(const JsonNode& node) {
    require_known_keys(node, {"frame", "pixel", "turn_deg", "align"});
    Placement placement;
    if (const JsonNode* n = find(node, "frame")) placement.frame = integer_of(*n, {0, 1e9});
    const JsonNode& pixel = member(node, "pixel");
    numbers_of(pixel, 2, {0, 16383});
    placement.pixel = {integer_of(pixel.items[0], {0, 16383}),
                       integer_of(pixel.items[1], {0, 16383})};
    if (const JsonNode* n = find(node, "turn_deg")) placement.turn_deg = number_of(*n, {-1e6, 1e6});
    if (const JsonNode* n = find(node, "align"))
        placement.align_normal = word_of(*n, {"up", "normal"}) == "normal";
    return placement;
}

std::vector<MotionKey> keys_of(const JsonNode& node) {
    const std::vector<JsonNode>& items = items_of(node);
    if (items.empty()) refuse(node, describe(node), "at least one {\"time\", \"transform\"}");
    std::vector<MotionKey> keys;
    for (const JsonNode& item : items) {
        require_known_keys(item, {"time", "transform"});
        keys.push_back(
            {number_of(member(item, "time"), any_time), transform_of(member(item, "transform"))});
    }
    require_increasing_times(items);
    return keys;
}

/// Where the object is: keyframes in the world, or with `place` within the base frame.
std::vector<MotionKey> motion_of(const JsonNode& node, const SceneEntry& entry) {
    const JsonNode* motion = find(node, "motion");
    const JsonNode* transform = find(node, "transform");
    if (entry.placement && transform)
        refuse(*transform, "both \"place\" and \"transform\"", "one of them");
    if (!entry.placement && !transform && !motion)
        refuse(node, "an object without a position", "\"place\", \"transform\" or \"motion\"");
    const bool relative = motion && motion->kind == JsonNode::Kind::object;
    if (relative) {
        require_known_keys(*motion, {"relative_to", "keyframes"});
        word_of(member(*motion, "relative_to"), {"place"});
        if (!entry.placement)
            refuse(*motion, "motion relative to a place that is not given", "\"place\"");
        std::vector<MotionKey> keys = keys_of(member(*motion, "keyframes"));
        for (MotionKey& key : keys)
            key.world_from_object = key.world_from_object * entry.base_from_object;
        return keys;
    }
    if (motion && entry.placement)
        refuse(*motion, "both \"place\" and motion in the world",
               "{\"relative_to\": \"place\", \"keyframes\": [...]}");
    if (motion) {
        if (transform) transform_of(*transform);
        return keys_of(*motion);
    }
    return {{0.0, entry.placement ? entry.base_from_object : transform_of(*transform)}};
}

/// Spheres stay spheres: their transforms must scale all axes alike.
void require_even_scale(const JsonNode& node, const SceneObject& object) {
    if (!std::holds_alternative<SphereShape>(object.parts.front().shape)) return;
    for (const MotionKey& key : object.motion) {
        const glm::dmat3 m(key.world_from_object);
        const double x = glm::length(m[0]);
        const double off =
            std::max(std::abs(glm::length(m[1]) - x), std::abs(glm::length(m[2]) - x));
        if (off > 1e-3 * x)
            refuse(node, "a sphere scaled unevenly", "the same scale along all axes, or a mesh");
    }
}

}  // namespace

SceneEntry entry_of(const JsonNode& node, const AssetFolders& assets,
                    std::vector<std::string>& warnings) {
    require_known_keys(node, {"name", "mesh", "sphere", "scale", "height", "up_axis", "place",
                              "transform", "motion", "material", "real"});
    SceneEntry entry;
    entry.object.name = text_of(member(node, "name"));
    if (entry.object.name.empty()) refuse(member(node, "name"), "an empty text", "a name");
    const bool mesh = find(node, "mesh") != nullptr, sphere = find(node, "sphere") != nullptr;
    if (mesh == sphere)
        refuse(node, mesh ? "both \"mesh\" and \"sphere\"" : "no shape",
               "one of \"mesh\" and \"sphere\"");
    if (const JsonNode* n = find(node, "real")) entry.object.real = boolean_of(*n);
    if (const JsonNode* n = find(node, "place")) entry.placement = placement_of(*n);
    if (mesh) read_mesh(entry, warnings, node, assets);
    if (sphere) read_sphere(entry, node, assets);
    entry.object.motion = motion_of(node, entry);
    require_even_scale(node, entry.object);
    return entry;
}

}  // namespace inlay
