// The fused surface as triangles: closed forms of a ball, closedness of anything, and PLY files.
#include "recordings/base/check.h"
#include "recordings/base/color.h"
#include "recordings/base/random.h"
#include "slam/mesh/extract_mesh.h"
#include "slam/mesh/write_ply.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numbers>
#include <sstream>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// A volume of `bricks`^3 bricks around the origin whose distances are given (voxel units).
VoxelVolume filled(int bricks, const std::function<float(const glm::vec3&)>& distance) {
    VoxelVolume volume;
    for (int z = -bricks / 2; z < bricks / 2; ++z) {
        for (int y = -bricks / 2; y < bricks / 2; ++y) {
            for (int x = -bricks / 2; x < bricks / 2; ++x)
                ensure_brick(volume, {x, y, z});
        }
    }
    for (Brick& brick : volume.bricks) {
        for (int i = 0; i < brick_voxels; ++i) {
            const glm::ivec3 voxel = brick.key * 8 + glm::ivec3(i & 7, (i >> 3) & 7, i >> 6);
            const auto slot = std::size_t(i);
            brick.distance[slot] = std::clamp(distance(glm::vec3(voxel)), -1.0f, 1.0f);
            brick.weight[slot] = 1;
            brick.color[0][slot] = 65535;
            brick.color[2][slot] = 13107;
            brick.color_weight[slot] = 1;
        }
    }
    return volume;
}

TriangleMesh ball_mesh(float radius) {
    return extract_mesh(filled(8, [&](const glm::vec3& p) {
        return (glm::length(p - glm::vec3(0.3f, 0.1f, -0.2f)) - radius) / 4;
    }));
}

/// Every directed edge once, and its opposite once: closed, and wound the same way all over.
bool watertight(const TriangleMesh& mesh) {
    std::map<std::pair<unsigned, unsigned>, int> edges;
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i)
            ++edges[{t[i], t[(i + 1) % 3]}];
    }
    return std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        const auto opposite = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && opposite != edges.end() && opposite->second == 1;
    });
}

TEST(ExtractMesh, ABallHasItsAreaItsVolumeAndNoHole) {
    const double radius = 20, voxel = VoxelVolume{}.voxel_size;
    const TriangleMesh mesh = ball_mesh(float(radius));
    double area = 0, volume = 0;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]);
        area += glm::length(glm::cross(b - a, c - a)) / 2;
        volume += glm::dot(a, glm::cross(b, c)) / 6;
    }
    const double pi = std::numbers::pi;
    // Chords of one voxel on a circle of 20: they fall short by (1/20)^2 / 8 and less.
    EXPECT_NEAR(area / (4 * pi * radius * radius * voxel * voxel), 1, 1e-3);
    // Positive: counter-clockwise seen from outside, where the distance is positive.
    EXPECT_NEAR(volume / (4.0 / 3 * pi * std::pow(radius * voxel, 3)), 1, 2e-3);
    EXPECT_TRUE(watertight(mesh));
    // Euler: V - E + F = 2, with 3 F = 2 E.
    EXPECT_EQ(mesh.positions.size() * 2, mesh.triangles.size() + 4);
}

TEST(ExtractMesh, NormalsAndColorsAreTheFields) {
    const TriangleMesh mesh = ball_mesh(20);
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    const glm::vec3 centre = glm::vec3(0.3f, 0.1f, -0.2f) * VoxelVolume{}.voxel_size;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 11) {
        // Central differences over two voxels of a ball of 20: (1/20)^2 / 6 and less.
        EXPECT_GT(glm::dot(mesh.normals[i], glm::normalize(mesh.positions[i] - centre)), 0.999f);
        EXPECT_LT(glm::length(mesh.colors[i] - glm::vec3(1, 0, 0.2f)), 1e-4f);
    }
}

TEST(ExtractMesh, AnyFieldThatIsClosedGivesAClosedMesh) {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const TriangleMesh mesh = extract_mesh(filled(4, [&](const glm::vec3& p) {
            const glm::ivec3 v(p);
            const bool border = glm::any(glm::greaterThan(glm::abs(v), glm::ivec3(13)));
            const auto cell = std::uint32_t((v.x + 50) + 100 * (v.y + 50) + 10000 * (v.z + 50));
            const float noise = 2 * uniform({seed, 0, cell, 0}, 0) - 1;
            // Zeros and tiny values too: corners that fall on lattice points are the hard case.
            return border ? 1.0f : (std::abs(noise) < 0.1f ? 0.0f : noise);
        }));
        EXPECT_GT(mesh.triangles.size(), 10000U);
        EXPECT_TRUE(watertight(mesh));
    }
}

TEST(ExtractMesh, UnknownSpaceIsNotClosedByASurface) {
    VoxelVolume volume = filled(2, [](const glm::vec3& p) { return p.z / 4; });
    for (Brick& brick : volume.bricks) {
        if (brick.key.x >= 0) continue;
        brick.distance.fill(unknown_distance);
        brick.weight.fill(0);
    }
    const TriangleMesh mesh = extract_mesh(volume);
    ASSERT_FALSE(mesh.triangles.empty());
    for (const glm::vec3& p : mesh.positions) {
        EXPECT_GE(p.x, 0);
        EXPECT_NEAR(p.z, 0, 1e-5);
    }
}

TEST(ExtractMesh, NothingGivesNothing) {
    EXPECT_TRUE(extract_mesh(VoxelVolume{}).triangles.empty());
}

class WritePly : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() /
                  ("inlay_ply_" + std::to_string(::getpid()) + "_" +
                   ::testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path folder_;
};

std::string read_all(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

TEST_F(WritePly, HoldsEveryVertexAndTriangle) {
    const TriangleMesh mesh = ball_mesh(6);
    write_ply(folder_ / "ball.ply", mesh);
    const std::string bytes = read_all(folder_ / "ball.ply");
    const std::string end = "end_header\n";
    const std::size_t body = bytes.find(end) + end.size();
    EXPECT_NE(bytes.find("element vertex " + std::to_string(mesh.positions.size()) + "\n"),
              std::string::npos);
    // Six floats and three bytes a vertex, a byte and three indices a triangle.
    EXPECT_EQ(bytes.size() - body, mesh.positions.size() * 27 + mesh.triangles.size() * 13);
    const auto red = std::uint8_t(bytes[body + 24]), blue = std::uint8_t(bytes[body + 26]);
    EXPECT_EQ((EncodedRgb{red, 0, blue}), encode(Rgb(1, 0, 0.2f)));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(WritePly, RefusesAFolderThatIsNotThere) {
    try {
        write_ply(folder_ / "absent" / "ball.ply", {});
        FAIL() << "no error";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ExitCode::cannot_create);
        EXPECT_NE(std::string(error.what()).find("absent"), std::string::npos);
    }
}

TEST_F(WritePly, AFullDiskLeavesTheOldFileAlone) {
    const TriangleMesh mesh = ball_mesh(20);
    std::ofstream(folder_ / "ball.ply") << "old";
    rlimit old{};
    ::getrlimit(RLIMIT_FSIZE, &old);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{4096, old.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);  // writing beyond it fails as on a full disk
    ExitCode code = ExitCode::done;
    try {
        write_ply(folder_ / "ball.ply", mesh);
    } catch (const Error& error) {
        code = error.code();
    }
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(code, ExitCode::disk_fault);
    EXPECT_EQ(read_all(folder_ / "ball.ply"), "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

}  // namespace
}  // namespace inlay
