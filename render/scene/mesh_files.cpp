#include "render/scene/mesh_files.h"

#include "recordings/base/check.h"
#include "render/scene/mesh_checks.h"
#include "render/scene/mesh_import.h"
#include "render/scene/mesh_size_check.h"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace inlay {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t max_triangles = 20'000'000;

struct Instance {
    const aiMesh* mesh = nullptr;
    glm::dmat4 file_from_mesh{1.0};
};

glm::dmat4 to_glm(const aiMatrix4x4& m) {
    return glm::transpose(glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2,
                                     m.c3, m.c4, m.d1, m.d2, m.d3, m.d4));
}

glm::vec3 to_glm(const aiVector3D& v) { return {v.x, v.y, v.z}; }

/// A file's sRGB color as linear color.
Rgb linear_color(const aiColor4D& c) {
    const auto byte = [](float v) {
        return std::uint8_t(std::lround(255 * (v > 0 ? std::min(v, 1.0f) : 0.0f)));
    };
    return decode(EncodedRgb{byte(c.r), byte(c.g), byte(c.b)});
}

/// Every mesh with its node's transform, in the order of the file.
std::vector<Instance> instances(const aiScene& scene) {
    std::vector<Instance> found;
    std::vector<std::pair<const aiNode*, glm::dmat4>> open{{scene.mRootNode, glm::dmat4(1.0)}};
    while (!open.empty()) {
        const auto [node, file_from_parent] = open.back();
        open.pop_back();
        const glm::dmat4 file_from_node = file_from_parent * to_glm(node->mTransformation);
        for (unsigned i = 0; i < node->mNumMeshes; ++i)
            found.push_back({scene.mMeshes[node->mMeshes[i]], file_from_node});
        for (unsigned i = node->mNumChildren; i-- > 0;)
            open.emplace_back(node->mChildren[i], file_from_node);
    }
    return found;
}

TriangleMesh to_triangles(const Instance& instance, const std::string& place) {
    const aiMesh& source = *instance.mesh;
    TriangleMesh mesh;
    const glm::dmat3 linear(instance.file_from_mesh);
    const double volume = glm::determinant(linear);
    require(std::isfinite(volume) && volume != 0,
            place + ": a node's transform is not finite or flattens the mesh; repair it");
    const glm::dmat3 for_normals = glm::transpose(glm::inverse(linear));
    for (unsigned i = 0; i < source.mNumVertices; ++i) {
        const glm::dvec4 p(to_glm(source.mVertices[i]), 1.0);
        mesh.positions.emplace_back(instance.file_from_mesh * p);
        if (source.HasNormals())
            mesh.normals.emplace_back(for_normals * glm::dvec3(to_glm(source.mNormals[i])));
        if (source.HasTextureCoords(0)) {
            const aiVector3D& uv = source.mTextureCoords[0][i];
            mesh.texture_coordinates.emplace_back(uv.x, 1 - uv.y);  // the importers' v points up
        }
        if (source.HasVertexColors(0)) mesh.colors.push_back(linear_color(source.mColors[0][i]));
    }
    for (unsigned i = 0; i < source.mNumFaces; ++i) {
        const aiFace& face = source.mFaces[i];
        if (face.mNumIndices != 3) continue;
        glm::uvec3 t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
        if (volume < 0) std::swap(t.y, t.z);  // a mirror turns the winding
        mesh.triangles.push_back(t);
    }
    return mesh;
}

void append(LoadedMesh& result, const Instance& instance, const std::optional<Material>& material,
            const std::string& place) {
    LoadedPart part{to_triangles(instance, place), material};
    validate(part.mesh, place);
    result.dropped_triangles += drop_degenerate_triangles(part.mesh);
    if (part.mesh.triangles.empty()) return;
    complete_normals(part.mesh);
    result.parts.push_back(std::move(part));
}

void require_few_triangles(const std::vector<Instance>& meshes, const fs::path& file) {
    std::size_t triangles = 0, vertices = 0;
    for (const Instance& instance : meshes) {
        triangles += instance.mesh->mNumFaces;
        vertices += instance.mesh->mNumVertices;
    }
    require(triangles <= max_triangles && vertices <= 3 * max_triangles,
            file.string() + ": " + std::to_string(triangles) + " triangles; expected at most " +
                std::to_string(max_triangles) + ", instances counted");
}

/// The glTF importer leaves out triangles whose indices are out of range, and says so nowhere.
void require_all_triangles(const MeshImport& import) {
    const aiScene& scene = *import.importer->GetScene();
    std::size_t found = 0;
    for (unsigned i = 0; i < scene.mNumMeshes; ++i)
        found += scene.mMeshes[i]->mNumFaces;
    const std::size_t listed = listed_triangles(import.file);
    require(found >= listed, import.file.string() + ": " + std::to_string(listed - found) + " of " +
                                 std::to_string(listed) +
                                 " triangles refer to vertices that do not exist; repair the mesh");
}

/// A PLY's vertex colors are its material. Those of other formats would multiply the file's
/// materials; they are left out.
void take_vertex_colors(std::optional<Material>& material, const fs::path& file,
                        std::vector<std::string>& warnings) {
    if (mesh_extension(file) == ".ply") {
        material = Diffuse{Rgb(1), nullptr, true};
        return;
    }
    const std::string text =
        file.string() + ": vertex colors are used from PLY files alone; these were left out";
    if (std::find(warnings.begin(), warnings.end(), text) == warnings.end())
        warnings.push_back(text);
}

LoadedMesh collect(const MeshImport& import, MeshMaterials materials) {
    const aiScene& scene = *import.importer->GetScene();
    const std::vector<Instance> meshes = instances(scene);
    require_all_triangles(import);
    require_few_triangles(meshes, import.file);
    LoadedMesh result;
    std::map<unsigned, std::optional<Material>> by_index;
    for (const Instance& instance : meshes) {
        const unsigned index = instance.mesh->mMaterialIndex;
        if (materials == MeshMaterials::read && !by_index.contains(index))
            by_index[index] = own_material(import, index, result.warnings);
        std::optional<Material> material = by_index[index];
        if (materials == MeshMaterials::read && instance.mesh->HasVertexColors(0))
            take_vertex_colors(material, import.file, result.warnings);
        append(result, instance, material,
               import.file.string() + ": mesh \"" + instance.mesh->mName.C_Str() + "\"");
    }
    require(!result.parts.empty(), import.file.string() + ": holds no triangle with an area (" +
                                       std::to_string(result.dropped_triangles) +
                                       " without); expected a surface");
    if (result.dropped_triangles > 0)
        result.warnings.push_back(import.file.string() + ": " +
                                  std::to_string(result.dropped_triangles) +
                                  " triangles without area were left out");
    return result;
}

}  // namespace

LoadedMesh load_mesh(const fs::path& file, const AssetFolders& assets, MeshMaterials materials) {
    std::error_code ignored;
    require(fs::is_regular_file(file, ignored), file.string() + ": no such file",
            ExitCode::input_missing);
    require(lies_within(assets, file),
            file.string() + ": lies outside the scene's folders; add its folder with --assets");
    require_plausible_counts(file);
    try {
        AssetFolders beside = assets;  // the mesh's references have their places beside it
        beside.within = place_of(assets, fs::canonical(file)).parent_path();
        return collect(import_mesh(fs::canonical(file), beside, materials), materials);
    } catch (const std::bad_alloc&) {
        throw Error(ExitCode::bad_data, file.string() + ": too large to be held in memory");
    }
}

}  // namespace inlay
