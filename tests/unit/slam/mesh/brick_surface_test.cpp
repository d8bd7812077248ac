// The surface brick by brick: vertices have what the sampler reads, and bricks share them.
#include "slam/mesh/brick_surface.h"

#include "recordings/base/random.h"
#include "slam/mesh/weld_surfaces.h"
#include "slam/volume/sample_volume.h"

#include <gtest/gtest.h>

namespace inlay {
namespace {

/// Bricks around `key` with any distances and colors; some voxels, and some bricks, are not there.
VoxelVolume ragged_volume(const glm::ivec3& key, std::uint32_t seed) {
    VoxelVolume volume;
    for (std::uint32_t i = 0; i < 27; ++i) {
        if (i != 13 && uniform({seed, 1, i, 0}, 0) < 0.2f) continue;
        ensure_brick(volume, key + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1);
    }
    for (std::uint32_t b = 0; b < volume.bricks.size(); ++b) {
        Brick& brick = volume.bricks[b];
        for (std::uint32_t i = 0; i < brick_voxels; ++i) {
            const SampleKey at{seed, b, i, 0};
            const float kind = uniform(at, 0);
            if (kind < 0.02f) continue;
            brick.distance[i] = kind < 0.1f ? 0.0f : 2 * uniform(at, 1) - 1;
            brick.color_weight[i] = kind < 0.5f ? 0 : 1;
            brick.color[1][i] = std::uint16_t(65535 * uniform(at, 2));
        }
    }
    return volume;
}

TEST(BrickSurface, GradientsAndColorsAreTheSamplersToTheBit) {
    std::size_t vertices = 0, known = 0;
    // In bricks: where floats are fine, and where they are not.
    for (const int far : {0, 100, 100000}) {
        const glm::ivec3 key(far, -far, 3);
        for (std::uint32_t seed = 1; seed <= 3; ++seed) {
            const VoxelVolume volume = ragged_volume(key, seed);
            VolumeSampler sampler(volume);
            for (const EdgeVertex& v : brick_surface(volume, *find_brick(volume, key)).vertices) {
                ASSERT_EQ(v.normal, sampler.gradient(v.position));
                ASSERT_EQ(v.color, volume_color(sampler, v.position).value_or(Rgb(0)));
                ++vertices;
                known += v.normal != glm::vec3(0);
            }
        }
    }
    EXPECT_GT(known, 500U);
    EXPECT_GT(vertices, known);
}

TEST(BrickSurface, NoTwoVerticesLieOnOneEdge) {
    const VoxelVolume volume = ragged_volume({0, 0, 0}, 1);
    const BrickSurface surface = brick_surface(volume, *find_brick(volume, {0, 0, 0}));
    const TriangleMesh welded = weld_surfaces({&surface, 1});
    EXPECT_EQ(welded.positions.size(), surface.vertices.size());
    EXPECT_EQ(welded.triangles, surface.triangles);
}

TEST(WeldSurfaces, VerticesOnOneEdgeBecomeTheFirst) {
    // Edges in a plane between bricks are named by a multiple of 16.
    const EdgeVertex a{{0, 1, 0}, {0, 0.5f, 0}}, b{{0, 0, 1}, {0, 0, 0.5f}},
        c{{3, 2, 2}, {1.5f, 1, 1}};
    const EdgeVertex other_a{{0, 1, 0}, {0, 0.6f, 0}}, other_b{{0, 0, 1}, {0, 0, 0.6f}},
        d{{-3, 2, 2}, {-1.5f, 1, 1}};
    const std::vector<BrickSurface> surfaces{
        {{a, b, c}, {{0, 1, 2}}}, {}, {{d, other_b, other_a}, {{0, 1, 2}, {2, 1, 0}}}};
    const TriangleMesh mesh = weld_surfaces(surfaces);
    const std::vector<glm::vec3> positions{a.position, b.position, c.position, d.position};
    const std::vector<glm::uvec3> triangles{{0, 1, 2}, {3, 1, 0}, {0, 1, 3}};
    EXPECT_EQ(mesh.positions, positions);
    EXPECT_EQ(mesh.triangles, triangles);
}

}  // namespace
}  // namespace inlay
