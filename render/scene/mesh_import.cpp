#include "render/scene/mesh_import.h"

#include "recordings/base/check.h"
#include "render/scene/mesh_size_check.h"
#include "render/scene/texture_files.h"

#include <assimp/BaseImporter.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>

namespace inlay {

namespace fs = std::filesystem;

namespace {

/// What an import asked for and did not get.
struct FileAccess {
    std::vector<std::string> refused, missing;
    bool opened_material_library = false;
};

/// Opens files for reading, and only within the asset folders. assimp asks for a virtual class.
class JailedFiles : public Assimp::DefaultIOSystem {
public:
    JailedFiles(AssetFolders assets, fs::path mesh_folder, FileAccess& access)
        : assets_(std::move(assets)), mesh_folder_(std::move(mesh_folder)), access_(access) {}

    bool Exists(const char* file) const override {
        return permitted(file) && Assimp::DefaultIOSystem::Exists(file);
    }

    Assimp::IOStream* Open(const char* file, const char* mode) override {
        std::error_code ignored;
        if (!permitted(file) || mode[0] != 'r') {
            access_.refused.emplace_back(file);
            return nullptr;
        }
        if (!fs::is_regular_file(file, ignored)) {
            access_.missing.emplace_back(file);
            return nullptr;
        }
        if (fs::path(file).extension() == ".mtl") access_.opened_material_library = true;
        note_opened(assets_, {fs::canonical(file), place_of_reference(file)});
        return Assimp::DefaultIOSystem::Open(file, "rb");
    }

private:
    bool permitted(const fs::path& file) const {
        return std::find(file.begin(), file.end(), "..") == file.end() &&
               lies_within(assets_, file);
    }

    /// A reference is relative to the mesh, and so is the place of what it names.
    fs::path place_of_reference(const fs::path& file) const {
        return (assets_.within / file.lexically_relative(mesh_folder_)).lexically_normal();
    }

    AssetFolders assets_;
    fs::path mesh_folder_;
    FileAccess& access_;
};

void keep_only_our_importers(Assimp::Importer& importer) {
    const std::vector<std::string> ours{
        "Wavefront Object Importer", "Stanford Polygon Library (PLY) Importer", "glTF2 Importer"};
    for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
        const std::string name = importer.GetImporterInfo(i)->mName;
        if (std::find(ours.begin(), ours.end(), name) != ours.end()) continue;
        Assimp::BaseImporter* other = importer.GetImporter(i);
        importer.UnregisterLoader(other);
        delete other;  // the importer has let go of it
    }
}

void require_access(const FileAccess& access, const fs::path& file, MeshMaterials materials) {
    if (!access.refused.empty())
        throw Error(ExitCode::bad_data, file.string() + ": refers to \"" + access.refused[0] +
                                            "\", which leads out of the scene's folders; put the "
                                            "file beside the mesh and refer to it by its name");
    const auto is_library = [](const std::string& name) { return name.ends_with(".mtl"); };
    const auto library = std::find_if(access.missing.begin(), access.missing.end(), is_library);
    require(library == access.missing.end() || access.opened_material_library ||
                materials == MeshMaterials::ignore,
            file.string() + ": refers to the material library \"" +
                (library == access.missing.end() ? "" : *library) +
                "\", which does not exist; add it, or give the object a material in the scene",
            ExitCode::input_missing);
}

std::shared_ptr<const Texture> embedded_texture(const aiTexture& texture, const std::string& place,
                                                bool linear) {
    require(texture.mHeight == 0,
            place + ": an uncompressed embedded texture; expected PNG or JPEG");
    const auto* bytes = reinterpret_cast<const std::byte*>(texture.pcData);
    return decode_texture({bytes, texture.mWidth}, place + ", embedded texture", linear);
}

std::shared_ptr<const Texture> texture_of(const MeshImport& import, const aiMaterial& material,
                                          aiTextureType type, bool linear = false) {
    aiString name;
    if (material.GetTexture(type, 0, &name) != AI_SUCCESS || name.length == 0) return nullptr;
    const aiScene& scene = *import.importer->GetScene();
    if (const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str()))
        return embedded_texture(*embedded, import.file.string(), linear);
    std::string relative = name.C_Str();
    std::replace(relative.begin(), relative.end(), '\\', '/');
    AssetFolders beside = import.assets;
    beside.folders.insert(beside.folders.begin(), import.file.parent_path());
    return load_texture(find_asset(beside, relative, import.file.string()), linear);
}

Rgb color_of(const aiColor3D& c) { return glm::clamp(Rgb(c.r, c.g, c.b), 0.0f, 1.0f); }

Rgb mean_of(const Texture& texture) {
    glm::dvec3 sum{0};
    for (const Rgb& texel : texture.pixels)
        sum += glm::dvec3(texel);
    return Rgb(sum / double(texture.pixels.size()));
}

Ggx gltf_material(const MeshImport& import, const aiMaterial& source,
                  std::vector<std::string>& warnings) {
    aiColor4D base(1, 1, 1, 1);
    float metallic = 1, roughness = 1;
    source.Get(AI_MATKEY_BASE_COLOR, base);
    source.Get(AI_MATKEY_METALLIC_FACTOR, metallic);
    source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness);
    if (const auto map = texture_of(import, source, aiTextureType_METALNESS, true)) {
        const Rgb mean = mean_of(*map);  // glTF 2.0: roughness in green, metallic in blue
        roughness *= mean.g;
        metallic *= mean.b;
        const auto differs = [&](const Rgb& t) {
            return t.g != map->pixels[0].g || t.b != map->pixels[0].b;
        };
        if (std::any_of(map->pixels.begin(), map->pixels.end(), differs))
            warnings.push_back(import.file.string() +
                               ": roughness and metallic vary over a texture; their mean is used");
    }
    return {color_of({base.r, base.g, base.b}), glm::vec2(std::clamp(roughness, 0.0f, 1.0f)),
            std::clamp(metallic, 0.0f, 1.0f), texture_of(import, source, aiTextureType_BASE_COLOR)};
}

}  // namespace

MeshImport import_mesh(const fs::path& file, const AssetFolders& assets, MeshMaterials materials) {
    FileAccess access;
    MeshImport import{std::make_shared<Assimp::Importer>(), file, assets};
    Assimp::Importer& importer = *import.importer;
    keep_only_our_importers(importer);
    auto* files = new JailedFiles(assets, file.parent_path(), access);
    importer.SetIOHandler(files);  // the importer owns it
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(
        file.string(), aiProcess_ValidateDataStructure | aiProcess_JoinIdenticalVertices |
                           aiProcess_Triangulate | aiProcess_SortByPType);
    importer.SetIOHandler(nullptr);  // `access` ends here, so the importer hands the files back
    delete files;
    require_access(access, file, materials);
    if (!scene && !access.missing.empty())
        throw Error(ExitCode::input_missing, file.string() + ": refers to \"" + access.missing[0] +
                                                 "\", which does not exist");
    require(scene && scene->mRootNode && scene->mNumMeshes > 0,
            file.string() + ": cannot be read as OBJ, PLY or glTF 2.0 (" +
                importer.GetErrorString() + "); check the file in a mesh viewer");
    return import;
}

std::optional<Material> own_material(const MeshImport& import, unsigned index,
                                     std::vector<std::string>& warnings) {
    const aiScene& scene = *import.importer->GetScene();
    if (index >= scene.mNumMaterials) return std::nullopt;
    const aiMaterial& source = *scene.mMaterials[index];
    if (source.GetName() == aiString(AI_DEFAULT_MATERIAL_NAME)) return std::nullopt;
    const std::string extension = mesh_extension(import.file);
    if (extension == ".gltf" || extension == ".glb") return gltf_material(import, source, warnings);
    if (extension != ".obj") return std::nullopt;
    aiColor3D reflectance(0.5f, 0.5f, 0.5f);
    source.Get(AI_MATKEY_COLOR_DIFFUSE, reflectance);
    return Diffuse{color_of(reflectance), texture_of(import, source, aiTextureType_DIFFUSE)};
}

}  // namespace inlay
