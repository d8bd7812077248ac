// Damaged and hostile meshes and textures: refused with the file's name and the right exit code.
#include "recordings/base/check.h"
#include "recordings/base/random.h"
#include "render/scene/mesh_files.h"
#include "render/scene/texture_files.h"
#include "tests/support/temporary_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;
using test::file_text;
using test::TemporaryFolder;
using testing::HasSubstr;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

class Meshes : public testing::Test {
protected:
    void write(const std::string& name, const std::string& bytes) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
    }
    LoadedMesh load(const std::string& name, MeshMaterials materials = MeshMaterials::read) {
        return load_mesh(folder / name, {{fs::canonical(folder.path())}}, materials);
    }
    void expect_refused(const std::string& name, const std::string& words,
                        ExitCode code = ExitCode::bad_data) {
        try {
            load(name);
            ADD_FAILURE() << "accepted; expected: " << words;
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), code) << error.what();
            EXPECT_THAT(error.what(), HasSubstr(name));
            EXPECT_THAT(error.what(), HasSubstr(words));
        }
    }
    TemporaryFolder folder;
};

TEST_F(Meshes, ObjIndicesOutOfRangeAreRefused) {
    for (const char* face : {"f 1 2 99999\n", "f 1 2 -99\n", "f 1 2 0\n"}) {
        write("a.obj", triangle + face);
        expect_refused("a.obj", "");
    }
}

TEST_F(Meshes, ObjValuesThatAreNoNumbersAreRefused) {
    for (const char* vertex : {"v nan 0 0\n", "v 0 inf 0\n", "v 0 0 -inf\n", "v 1e30 0 0\n"}) {
        write("a.obj", vertex + triangle + "f 1 2 3\n");
        expect_refused("a.obj", "vertex");
    }
}

TEST_F(Meshes, ObjTextureCoordinatesThatAreNoneBecomeHarmless) {
    write("a.obj", triangle + "vt nan 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/3\n");
    const LoadedMesh mesh = load("a.obj");
    for (const glm::vec2& uv : mesh.parts.at(0).mesh.texture_coordinates)
        EXPECT_TRUE(std::isfinite(uv.x + uv.y));
    write("a.obj", triangle + "vt 0 0\nf 1/7 2/7 3/7\n");  // out of range
    EXPECT_TRUE(load("a.obj").parts.at(0).mesh.texture_coordinates.empty());
}

TEST_F(Meshes, EmptyAndForeignFilesAreRefused) {
    write("a.obj", "");
    expect_refused("a.obj", "");
    write("a.obj", triangle);
    expect_refused("a.obj", "");
    write("a.obj", std::string("\0\xff\x01garbage", 10));
    expect_refused("a.obj", "");
    write("a.stl", "solid a\nendsolid a\n");
    expect_refused("a.stl", ".obj, .ply, .gltf or .glb");
    expect_refused("none.obj", "no such file", ExitCode::input_missing);
}

TEST_F(Meshes, TrianglesWithoutAreaAreDroppedAndCounted) {
    write("a.obj", triangle + "v 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
    const LoadedMesh mesh = load("a.obj");
    EXPECT_EQ(mesh.parts.at(0).mesh.triangles.size(), 1u);
    EXPECT_EQ(mesh.dropped_triangles, 2);
    EXPECT_EQ(mesh.warnings.size(), 1u);
    write("b.obj", triangle + "v 2 0 0\nf 1 2 4\n");
    expect_refused("b.obj", "no triangle with an area");
}

TEST_F(Meshes, PolygonsAreCutAndNormalsMade) {
    write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 2 0\nv 0 1 0\nf 1 2 3 4 5\n");
    const TriangleMesh mesh = load("a.obj").parts.at(0).mesh;
    EXPECT_EQ(mesh.triangles.size(), 3u);
    for (const glm::vec3& n : mesh.normals)
        EXPECT_EQ(n, glm::vec3(0, 0, 1));
}

TEST_F(Meshes, PlyCountsThatTheFileCannotHoldAreRefused) {
    const auto ply = [](const std::string& vertices, const std::string& faces) {
        return "ply\nformat ascii 1.0\nelement vertex " + vertices +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
               "\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 "
               "2\n";
    };
    write("a.ply", ply("3", "1"));
    EXPECT_EQ(load("a.ply").parts.at(0).mesh.triangles.size(), 1u);
    for (const char* count : {"4000000000", "99999999999999999999", "-1", "many"}) {
        write("a.ply", ply(count, "1"));
        expect_refused("a.ply", "line 3");
        write("a.ply", ply("3", count));
        expect_refused("a.ply", "line 7");
    }
    std::string far = ply("3", "1");
    far.replace(far.find("3 0 1 2"), 7, "3 0 1 77");
    write("a.ply", far);
    expect_refused("a.ply", "");
    write("a.ply", "ply\nformat ascii 1.0\n");
    expect_refused("a.ply", "end_header");
}

TEST_F(Meshes, MaterialLibrariesOutsideTheFolderAreNotOpened) {
    for (const char* library : {"../../../../etc/passwd", "../x.mtl"}) {
        write("a.obj", "mtllib " + std::string(library) + "\n" + triangle + "f 1 2 3\n");
        expect_refused("a.obj", "leads out");
    }
    const TemporaryFolder outside;
    std::ofstream(outside / "x.mtl") << "newmtl m\nKd 1 0 0\n";
    fs::create_symlink(outside / "x.mtl", folder / "x.mtl");
    write("a.obj", "mtllib x.mtl\n" + triangle + "usemtl m\nf 1 2 3\n");
    expect_refused("a.obj", "leads out");
}

TEST_F(Meshes, MissingLibrariesAndTexturesMatterOnlyWhenWanted) {
    write("a.obj", "mtllib none.mtl\n" + triangle + "f 1 2 3\n");
    expect_refused("a.obj", "none.mtl", ExitCode::input_missing);
    EXPECT_EQ(load("a.obj", MeshMaterials::ignore).parts.size(), 1u);
    write("m.mtl", "newmtl m\nKd 0.25 0.5 1\nmap_Kd none.png\n");
    write("b.obj", "mtllib m.mtl\n" + triangle + "usemtl m\nf 1 2 3\n");
    expect_refused("b.obj", "none.png", ExitCode::input_missing);
    EXPECT_EQ(load("b.obj", MeshMaterials::ignore).parts.size(), 1u);
    write("m.mtl", "newmtl m\nKd 0.25 0.5 1\nmap_Kd ../../none.png\n");
    expect_refused("b.obj", "..");
    write("m.mtl", "newmtl m\nKd 0.25 0.5 1\n");
    EXPECT_EQ(std::get<Diffuse>(load("b.obj").parts[0].material.value()).reflectance,
              Rgb(0.25f, 0.5f, 1));
}

/// A glTF triangle whose numbers lie in t.bin: three positions, then three 16-bit indices.
std::string gltf(const std::string& uri, const std::string& count, const std::string& offset) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
      "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
      "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
      "buffers": [{"uri": ")" +
           uri + R"(", "byteLength": 42}],
      "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36},
                      {"buffer": 0, "byteOffset": )" +
           offset + R"(, "byteLength": 6}],
      "accessors": [{"bufferView": 0, "componentType": 5126, "count": )" +
           count +
           R"(, "type": "VEC3", "min": [0,0,0], "max": [1,1,1]},
                    {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]})";
}

std::string buffer(std::uint16_t last_index) {
    const float positions[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const std::uint16_t indices[3] = {0, 1, last_index};
    std::string bytes(reinterpret_cast<const char*>(positions), 36);
    return bytes.append(reinterpret_cast<const char*>(indices), 6);
}

/// The texture's two texels differ: green (roughness) 10 and 200, blue (metallic) 0 and 100.
TEST_F(Meshes, OfVaryingRoughnessTheMeanIsUsedWithAWarning) {
    write("t.bin", buffer(2));
    std::string text = gltf("t.bin", "3", "36");
    text.replace(text.find("\"indices\": 1"), 12, "\"indices\": 1, \"material\": 0");
    text.insert(1, R"("materials": [{"pbrMetallicRoughness": {"metallicRoughnessTexture":
      {"index": 0}}}], "textures": [{"source": 0}], "images": [{"uri": "data:image/png;base64,
iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mNg4GJgOJECAAItATfdPuyMAAAAAElFTkSuQmCC"}],)");
    text.erase(text.find("base64,\n") + 7, 1);
    write("a.gltf", text);
    const LoadedMesh mesh = load("a.gltf");
    const auto& paint = std::get<Ggx>(mesh.parts.at(0).material.value());
    EXPECT_NEAR(paint.roughness.x, 105 / 255.0, 1e-6);  // float
    EXPECT_NEAR(paint.metallic, 50 / 255.0, 1e-6);
    ASSERT_EQ(mesh.warnings.size(), 1u);
    EXPECT_NE(mesh.warnings[0].find("a.gltf: roughness and metallic vary"), std::string::npos);
}

TEST_F(Meshes, GltfBuffersAreChecked) {
    write("t.bin", buffer(2));
    write("a.gltf", gltf("t.bin", "3", "36"));
    const LoadedMesh good = load("a.gltf");
    EXPECT_EQ(good.parts.at(0).mesh.triangles.size(), 1u);
    EXPECT_EQ(good.parts.at(0).mesh.positions.at(1), glm::vec3(2, 0, 0));  // the node's scale
    write("a.gltf", gltf("t.bin", "3000", "36"));
    expect_refused("a.gltf", "");
    write("a.gltf", gltf("t.bin", "4000000000", "36"));
    expect_refused("a.gltf", "accessors[0]");
    write("a.gltf", gltf("t.bin", "3", "40"));
    expect_refused("a.gltf", "");
    write("a.gltf", gltf("../t.bin", "3", "36"));
    expect_refused("a.gltf", "leads out");
    write("a.gltf", gltf("none.bin", "3", "36"));
    expect_refused("a.gltf", "none.bin", ExitCode::input_missing);
    write("t.bin", buffer(500));
    write("a.gltf", gltf("t.bin", "3", "36"));
    expect_refused("a.gltf", "");
    write("u.bin", buffer(2) + std::string("\0\0\1\0\xf4\1", 6));  // a second triangle: 0, 1, 500
    std::string two = gltf("u.bin", "3", "36");
    two.replace(two.find("\"byteLength\": 42"), 16, "\"byteLength\": 48");
    two.replace(two.find("\"byteLength\": 6}"), 15, "\"byteLength\": 12");
    two.replace(two.find("\"count\": 3, \"type\": \"SCALAR\""), 10, "\"count\": 6");
    write("a.gltf", two);
    expect_refused("a.gltf", "1 of 2 triangles refer to vertices that do not exist");
    write("t.bin", buffer(2).substr(0, 20));
    expect_refused("a.gltf", "");
    write("a.gltf", "{\"asset\": {\"version\": \"2.0\"}, \"accessors\": [3]}");
    expect_refused("a.gltf", "accessors[0]");
    write("a.gltf", "{\"asset\": ");
    expect_refused("a.gltf", "not valid glTF");
    write("a.glb", "glTF\x02");
    expect_refused("a.glb", "cut off");
}

TEST_F(Meshes, DamagedTexturesAreRefused) {
    const std::string png = file_text(fs::path(INLAY_SOURCE_DIR) / "apps/scenes/vase/vase.png");
    ASSERT_GT(png.size(), 1000u);
    write("t.png", png);
    EXPECT_EQ(load_texture(folder / "t.png")->width, 768);
    for (const double share : {0.0, 0.01, 0.5, 0.99}) {
        write("t.png", png.substr(0, std::size_t(double(png.size()) * share)));
        EXPECT_THROW(load_texture(folder / "t.png"), Error) << share;
    }
    std::string huge = png;
    huge[16] = 0x7f;  // the width's first byte
    write("t.png", huge);
    EXPECT_THROW(load_texture(folder / "t.png"), Error);
}

TEST_F(Meshes, RandomDamageIsReadOrRefusedAndNothingElse) {
    const std::string obj =
        "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "vn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/3/1\nf 2/2 4/3 3/3\nf 1 2 4 3\n";
    write("m.mtl", "newmtl m\nKd 0.25 0.5 1\n");
    write("t.bin", buffer(2));
    const std::string text = gltf("t.bin", "3", "36");
    int read = 0, refused = 0;
    for (std::uint32_t seed = 0; seed < 400; ++seed) {
        for (const bool wavefront : {true, false}) {
            std::string bytes = wavefront ? obj : text;
            for (std::uint32_t e = 0; e < 2; ++e) {
                const SampleKey key{seed, 0, 0, e};
                bytes[std::size_t(uniform(key, 0) * float(bytes.size()))] =
                    "0123456789-./ ev\n\"{}["[int(uniform(key, 1) * 21)];
            }
            const std::string name = wavefront ? "r.obj" : "r.gltf";
            write(name, bytes);
            try {
                for (const LoadedPart& part : load(name).parts)
                    for (const glm::vec3& p : part.mesh.positions)
                        ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
                ++read;
            } catch (const Error&) {
                ++refused;
            }  // anything else fails the test
        }
    }
    EXPECT_GT(read, 30);
    EXPECT_GT(refused, 50);
}

}  // namespace
}  // namespace inlay
