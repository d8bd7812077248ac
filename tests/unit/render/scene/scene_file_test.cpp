// What a scene description means: positions, materials, scales, environments, and the meshes at
// hand.
#include "render/scene/scene_file.h"

#include "recordings/base/check.h"
#include "render/scene/mesh_files.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

const fs::path meshes = fs::path(INLAY_DATA_DIR) / "meshes";
const fs::path scenes = fs::path(INLAY_SOURCE_DIR) / "apps" / "scenes";

void write(const fs::path& file, const std::string& text) { std::ofstream(file) << text; }

/// A box of 2 x 4 x 1 with its lowest corner at (1, 10, 5).
const std::string box_obj =
    "v 1 10 5\nv 3 10 5\nv 3 14 5\nv 1 14 5\nv 1 10 6\nv 3 10 6\nv 3 14 6\nv 1 14 6\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n";

SceneFile load(const std::string& objects, const std::string& more = "") {
    const TemporaryFolder folder;
    write(folder / "box.obj", box_obj);
    write(folder / "s.json",
          R"({"version": 1, "environment": {"constant": [1,1,1]}, "objects": [)" + objects + "]" +
              more + "}");
    return load_scene_file(folder / "s.json");
}

const TriangleMesh& mesh_of(const SceneEntry& entry) {
    return *std::get<MeshShape>(entry.object.parts.at(0).shape).mesh;
}

std::pair<glm::vec3, glm::vec3> bounds(const TriangleMesh& mesh) {
    glm::vec3 least = mesh.positions.at(0), greatest = least;
    for (const glm::vec3& p : mesh.positions)
        least = glm::min(least, p), greatest = glm::max(greatest, p);
    return {least, greatest};
}

TEST(SceneFile, PutsTheBaseUnderTheMiddleOfTheBox) {
    const SceneFile scene =
        load(R"({"name": "b", "mesh": "box.obj", "height": 0.2, "place": {"pixel": [3, 4]}})");
    const SceneEntry& entry = scene.entries.at(0);
    const auto [least, greatest] = bounds(mesh_of(entry));
    EXPECT_NEAR(greatest.y - least.y, 0.2, 1e-6);  // float
    const glm::dvec4 lowest_middle((least.x + greatest.x) / 2, least.y, (least.z + greatest.z) / 2,
                                   1);
    EXPECT_LT(glm::length(entry.base_from_object * lowest_middle - glm::dvec4(0, 0, 0, 1)), 1e-6);
    EXPECT_EQ(entry.object.motion.at(0).world_from_object, entry.base_from_object);
    EXPECT_EQ(entry.placement->pixel, glm::ivec2(3, 4));
    EXPECT_EQ(mesh_of(entry).triangles.size(), 12u);
    EXPECT_EQ(mesh_of(entry).normals.size(), mesh_of(entry).positions.size());
}

TEST(SceneFile, TurnsZUpMeshesToStand) {
    const SceneFile scene = load(
        R"({"name": "b", "mesh": "box.obj", "up_axis": "z", "scale": 0.5, "place": {"pixel": [3, 4]}})");
    const auto [least, greatest] = bounds(mesh_of(scene.entries[0]));
    // (x, y, z) -> (x, z, -y): heights were z = 5..6, depths y = 10..14.
    EXPECT_LT(glm::length(least - glm::vec3(0.5f, 2.5f, -7.0f)), 1e-6f);
    EXPECT_LT(glm::length(greatest - glm::vec3(1.5f, 3.0f, -5.0f)), 1e-6f);
}

TEST(SceneFile, ReadsTransformsRowByRowAndLetsMotionOverrideThem) {
    const SceneFile scene = load(
        R"({"name": "b", "sphere": {"radius": 0.1}, "transform": [0,-2,0,5, 2,0,0,6, 0,0,2,7, 0,0,0,1]},
           {"name": "c", "sphere": {"radius": 0.1}, "transform": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1],
            "motion": [{"time": 1, "transform": [1,0,0,2, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
                       {"time": 2, "transform": [1,0,0,4, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]})");
    const glm::dmat4& m = scene.entries.at(0).object.motion.at(0).world_from_object;
    EXPECT_EQ(m * glm::dvec4(1, 0, 0, 1), glm::dvec4(5, 8, 7, 1));
    EXPECT_NEAR(transform_at(scene.entries.at(1).object, 1.5)[3].x, 3, 1e-12);
    EXPECT_FALSE(scene.entries[0].placement.has_value());
}

TEST(SceneFile, MotionRelativeToThePlaceStandsOnItsBase) {
    const SceneFile scene = load(
        R"({"name": "b", "sphere": {"radius": 0.1}, "place": {"frame": 7, "pixel": [3, 4], "turn_deg": 30,
            "align": "normal"}, "motion": {"relative_to": "place", "keyframes": [
            {"time": 0, "transform": [1,0,0,0.5, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}})");
    const SceneEntry& entry = scene.entries.at(0);
    EXPECT_EQ(entry.placement->frame, 7);
    EXPECT_TRUE(entry.placement->align_normal);
    const glm::dvec3 centre(entry.object.motion.at(0).world_from_object[3]);
    EXPECT_LT(glm::length(centre - glm::dvec3(0.5, 0.1, 0)), 1e-12);
}

TEST(SceneFile, ReadsEveryKindOfMaterial) {
    const SceneFile scene = load(
        R"({"name": "a", "sphere": {"radius": 1}, "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
            "real": true, "material": {"type": "diffuse", "reflectance": [0.1, 0.2, 0.3]}},
           {"name": "b", "sphere": {"radius": 1}, "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
            "material": {"type": "phong", "diffuse": [0.1,0.1,0.1], "specular": [0.8,0.8,0.8], "exponent": 64}},
           {"name": "c", "sphere": {"radius": 1}, "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
            "material": {"type": "ggx", "base_color": [1,0.5,0], "roughness": [0.2, 0.4], "metallic": 1}})");
    const auto material = [&](std::size_t i) {
        return scene.entries.at(i).object.parts.at(0).material;
    };
    EXPECT_EQ(std::get<Diffuse>(material(0)).reflectance, Rgb(0.1f, 0.2f, 0.3f));
    EXPECT_TRUE(scene.entries[0].object.real);
    EXPECT_EQ(std::get<Phong>(material(1)).exponent, 64);
    EXPECT_EQ(std::get<Ggx>(material(2)).roughness, glm::vec2(0.2f, 0.4f));
}

TEST(SceneFile, ReadsViewAndPath) {
    const SceneFile scene =
        load("", R"(, "view": {"width": 64, "height": 48, "lens": [50, 50, 31.5, 23.5],
        "world_from_camera": [1,0,0,1, 0,-1,0,2, 0,0,-1,3, 0,0,0,1]},
        "path": [{"time": 0, "world_from_camera": [1,0,0,1, 0,1,0,2, 0,0,1,3, 0,0,0,1]}])");
    ASSERT_TRUE(scene.view.has_value());
    EXPECT_EQ(scene.view->up, glm::dvec3(0, 1, 0));
    EXPECT_EQ(scene.view->world_from_camera * glm::dvec3(0, 0, 1), glm::dvec3(1, 2, 2));
    EXPECT_EQ(scene.path.size(), 1u);
}

TEST(LoadEnvironment, ScalesAndAlignsADescribedLight) {
    EnvironmentSpec spec;
    spec.source = DescribedLight{Rgb(0.5f), {{{0, 0, 1}, 50, Rgb(2)}}};
    spec.scale = 2;
    const LoadedEnvironment loaded = load_environment(spec, {0, -1, 0}, {0, 0.3, 1});
    // The lobe lies along the map's +z, which is the horizontal part of the view direction.
    EXPECT_NEAR(radiance_from(loaded.map, {0, 0, 1}).r, 2 * (0.5 + 2), 0.1);  // half a texel off
    EXPECT_NEAR(radiance_from(loaded.map, {0, 0, -1}).r, 1, 1e-6);
}

TEST(ProjectScenes, LoadWithTheProjectsOwnFilesAlone) {
    for (const char* name : {"kitchen.json", "livingroom.json", "rpy.json"}) {
        const SceneFile scene = load_scene_file(scenes / name);
        ASSERT_EQ(scene.entries.size(), 3u) << name;
        EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.at(0);
        const auto& vase = std::get<Diffuse>(scene.entries[0].object.parts.at(0).material);
        ASSERT_NE(vase.texture, nullptr);
        EXPECT_GT(scene.entries[2].object.motion.size(), 1u) << name;
    }
}

TEST(MeshFiles, TheMeshesAtHandHaveTheCountsOfTheirFiles) {
    if (!fs::exists(meshes)) GTEST_SKIP() << meshes << " is absent";
    const LoadedMesh spot =
        load_mesh(meshes / "spot" / "spot_triangulated.obj", {{fs::canonical(meshes)}});
    ASSERT_EQ(spot.parts.size(), 1u);
    EXPECT_EQ(spot.parts[0].mesh.triangles.size(), 5856u);
    EXPECT_FALSE(spot.parts[0].material.has_value());
    const LoadedMesh monkey =
        load_mesh(meshes / "monkey" / "monkey.obj", {{fs::canonical(meshes)}});
    ASSERT_EQ(monkey.parts.size(), 1u);
    const auto& paint = std::get<Diffuse>(monkey.parts[0].material.value());
    EXPECT_NEAR(paint.reflectance.r, 0.9, 1e-6);
    ASSERT_NE(paint.texture, nullptr);
    const LoadedMesh cube =
        load_mesh(meshes / "cube_gltf" / "Cube.gltf", {{fs::canonical(meshes)}});
    ASSERT_EQ(cube.parts.size(), 1u);
    EXPECT_EQ(cube.parts[0].mesh.triangles.size(), 12u);
    const auto& metal = std::get<Ggx>(cube.parts[0].material.value());
    ASSERT_NE(metal.texture, nullptr);
    for (const LoadedMesh* m : {&spot, &monkey, &cube}) {
        const TriangleMesh& mesh = m->parts[0].mesh;
        RecordProperty("vertices and triangles", std::to_string(mesh.positions.size()) + " " +
                                                     std::to_string(mesh.triangles.size()) +
                                                     " dropped " +
                                                     std::to_string(m->dropped_triangles));
        EXPECT_EQ(mesh.texture_coordinates.size(), mesh.positions.size());
        for (const glm::vec3& n : mesh.normals)
            EXPECT_NEAR(glm::length(n), 1, 1e-5);  // float
    }
}

TEST(MeshFiles, VertexColorsOfAPlyAreItsReflectance) {
    const TemporaryFolder folder;
    write(folder / "a.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
          "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
          "0 0 0 255 0 0\n1 0 0 0 188 0\n0 1 0 0 0 10\n3 0 1 2\n");
    const LoadedMesh loaded = load_mesh(folder / "a.ply", {{fs::canonical(folder / ".")}});
    const LoadedPart& part = loaded.parts.at(0);
    const auto& paint = std::get<Diffuse>(part.material.value());
    EXPECT_TRUE(paint.vertex_colors);
    EXPECT_EQ(paint.reflectance, Rgb(1));
    ASSERT_EQ(part.mesh.colors.size(), part.mesh.positions.size());
    for (std::size_t i = 0; i < part.mesh.positions.size(); ++i) {
        const glm::vec3& p = part.mesh.positions[i];
        const EncodedRgb expected = p.x > 0   ? EncodedRgb{0, 188, 0}
                                    : p.y > 0 ? EncodedRgb{0, 0, 10}
                                              : EncodedRgb{255, 0, 0};
        EXPECT_EQ(part.mesh.colors[i], decode(expected));
    }
    EXPECT_TRUE(loaded.warnings.empty());
}

TEST(MeshFiles, VertexColorsOfOtherFormatsAreLeftOutWithAWarning) {
    const TemporaryFolder folder;
    write(folder / "a.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n");
    const LoadedMesh colored = load_mesh(folder / "a.obj", {{fs::canonical(folder / ".")}});
    ASSERT_EQ(colored.warnings.size(), 1u);
    EXPECT_NE(colored.warnings[0].find("a.obj: vertex colors"), std::string::npos);
}

TEST(MeshFiles, TextureCoordinatesStartAtTheTopLeft) {
    if (!fs::exists(meshes)) GTEST_SKIP() << meshes << " is absent";
    // The only pure black of spot's texture are her eyes: one on each side of the head, at -z.
    const TemporaryFolder folder;
    fs::copy(meshes / "spot" / "spot_triangulated.obj", folder / "spot.obj");
    fs::copy(meshes / "spot" / "spot_texture.png", folder / "spot.png");
    write(folder / "s.json", R"({"version": 1, "environment": {"constant": [1,1,1]}, "objects": [
        {"name": "spot", "mesh": "spot.obj", "transform": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
         "material": {"type": "diffuse", "reflectance": [1,1,1], "texture": "spot.png"}}]})");
    const SceneFile scene = load_scene_file(folder / "s.json");
    const TriangleMesh& mesh = mesh_of(scene.entries.at(0));
    const Texture& texture = *std::get<Diffuse>(scene.entries[0].object.parts[0].material).texture;
    int left = 0, right = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i <= 8; ++i) {
            for (int j = 0; i + j <= 8; ++j) {
                const glm::vec3 w(float(i) / 8, float(j) / 8, float(8 - i - j) / 8);
                const auto mix = [&](const auto& v) {
                    return w.x * v[t.x] + w.y * v[t.y] + w.z * v[t.z];
                };
                const glm::vec2 uv = mix(mesh.texture_coordinates);
                const Rgb c =
                    texture(std::clamp(int(uv.x * float(texture.width)), 0, texture.width - 1),
                            std::clamp(int(uv.y * float(texture.height)), 0, texture.height - 1));
                if (luminance(c) > 0.001f) continue;
                const glm::vec3 p = mix(mesh.positions);
                EXPECT_LT(p.z, -0.4f);
                EXPECT_GT(p.y, 0.2f);
                (p.x < 0 ? left : right) += 1;
            }
        }
    }
    EXPECT_GT(left, 20);
    EXPECT_NEAR(left, right, 0.2 * (left + right));  // the tessellation differs a little
}

}  // namespace
}  // namespace inlay
