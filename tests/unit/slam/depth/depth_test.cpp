// Cleaning, smoothing, halving and differentiating one depth image.
#include "slam/depth/camera_view.h"
#include "slam/depth/depth_pyramid.h"
#include "slam/depth/filter_depth.h"
#include "slam/depth/surface_from_depth.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

Lens bent_lens() {
    return {640, 480, 517.3, 516.5, 318.6, 255.3, 0.2624, -0.9531, 1.1633, -0.0054, 0.0026};
}

TEST(FilterDepth, DropsWhatIsNotAMeasurement) {
    Image<float> depth(9, 9, 1.0f);
    depth(0, 0) = NAN;
    depth(2, 2) = INFINITY;
    depth(4, 4) = -1;
    depth(6, 6) = 0.01f;
    depth(8, 8) = 1000;
    const Image<float> clean = filter_depth(depth, {});
    for (const int i : {0, 2, 4, 6, 8})
        EXPECT_EQ(clean(i, i), 0);
    EXPECT_NEAR(clean(3, 4), 1, 1e-6);
}

TEST(FilterDepth, DropsFlyingPixelsAndKeepsBothSurfaces) {
    Image<float> depth(20, 9, 1.0f);
    for (int y = 0; y < 9; ++y) {
        for (int x = 10; x < 20; ++x)
            depth(x, y) = 2;
    }
    depth(10, 4) = 1.5f;
    const Image<float> clean = clean_depth(depth, {});
    EXPECT_EQ(clean(10, 4), 0);
    EXPECT_EQ(clean(9, 4), 1);
    EXPECT_EQ(clean(11, 4), 2);
}

/// A plane at 76 degrees from the line of sight: at 0.8 m it recedes by 1.1 cm a pixel, more than
/// an edge between two surfaces needs. Pixels to both sides see a wall.
Image<float> grazing_face(const Lens& lens, int first, int end) {
    Image<float> depth(lens.width, lens.height, 2.0f);
    for (int y = 0; y < lens.height; ++y) {
        for (int x = first; x < end; ++x) {
            const glm::dvec3 ray = unproject(lens, {x, y});
            depth(x, y) = float(0.2 / (0.25 - ray.x));
        }
    }
    return depth;
}

const Lens quarter_lens{80, 60, 262.5, 262.5, 39.5, 29.5};

TEST(FilterDepth, KeepsASurfaceSeenAtAGrazingAngle) {
    const Image<float> depth = grazing_face(quarter_lens, 30, 42);
    const Image<float> clean = clean_depth(depth, {});
    DepthSettings as_edges;
    as_edges.steepest = 0;
    const Image<float> without = clean_depth(depth, as_edges);
    for (int y = 0; y < 60; ++y) {
        for (int x = 30; x < 42; ++x)
            ASSERT_EQ(clean(x, y), depth(x, y)) << x << ", " << y;
    }
    EXPECT_EQ(without(36, 30), 0);
}

TEST(FilterDepth, DropsALineOfFlyingPixelsAlongAnEdge) {
    for (const float slant : {0.0f, 0.6f}) {
        Image<float> depth(40, 40, 1.0f);
        for (int y = 0; y < 40; ++y) {
            const int edge = 8 + int(slant * float(y));
            for (int x = edge; x < 40; ++x)
                depth(x, y) = x == edge ? 1.02f : 1.04f;
        }
        const Image<float> clean = clean_depth(depth, {});
        for (int y = 1; y < 39; ++y)
            ASSERT_EQ(clean(8 + int(slant * float(y)), y), 0) << slant << ", " << y;
    }
}

TEST(SmoothDepth, NeverMixesTwoSurfaces) {
    Image<float> depth(40, 20, 1.0f);
    for (int y = 0; y < 20; ++y) {
        for (int x = 20; x < 40; ++x)
            depth(x, y) = 1.2f;
    }
    const Image<float> smooth = smooth_depth(depth, {});
    for (int x = 0; x < 40; ++x) {  // 1e-6: rounding of a weighted mean of equal numbers
        EXPECT_NEAR(smooth(x, 10), x < 20 ? 1.0f : 1.2f, 1e-6);
    }
}

TEST(SmoothDepth, RemovesMostOfTheNoiseOfAPlane) {
    Image<float> depth(60, 60);
    for (std::size_t i = 0; i < depth.pixels.size(); ++i) {
        depth.pixels[i] = 1.5f + 0.006f * (uniform({1, 0, std::uint32_t(i), 0}, 0) - 0.5f);
    }
    const Image<float> smooth = smooth_depth(depth, {});
    double before = 0, after = 0;
    for (int y = 10; y < 50; ++y) {
        for (int x = 10; x < 50; ++x) {
            before += std::pow(depth(x, y) - 1.5, 2);
            after += std::pow(smooth(x, y) - 1.5, 2);
        }
    }
    // A Gaussian of 2 px averages about 4 pi 2^2 = 50 pixels, cut to 7 x 7 about 30.
    EXPECT_LT(after, before / 15);
}

TEST(DepthPyramid, HalvedPixelsLookBetweenTheFourTheyReplace) {
    const Lens lens{640, 480, 525, 520, 319.5, 239.5};
    const DepthLevel coarse = halve({Image<float>(640, 480, 1.0f), lens}, {});
    for (const glm::ivec2 at : {glm::ivec2(0, 0), glm::ivec2(319, 239), glm::ivec2(100, 7)}) {
        const glm::dvec3 between = unproject(lens, glm::dvec2(2 * at) + 0.5);
        EXPECT_LT(glm::length(unproject(coarse.lens, glm::dvec2(at)) - between), 1e-12);
    }
}

TEST(DepthPyramid, KeepsHolesAndTheNearerSurface) {
    DepthLevel fine{Image<float>(4, 2, 0.0f), Lens{4, 2, 4, 4, 1.5, 0.5}};
    fine.depth(0, 0) = 1;
    fine.depth(1, 1) = 3;
    const DepthLevel coarse = halve(fine, {});
    EXPECT_EQ(coarse.depth(0, 0), 1);
    EXPECT_EQ(coarse.depth(1, 0), 0);
    EXPECT_EQ(depth_pyramid(fine.depth, fine.lens, 2, {}).size(), 2U);
}

TEST(CameraView, EveryPixelsRayLeadsBackToThePixel) {
    for (const Lens& lens : {bent_lens(), Lens{40, 30, 30, -30, 19.5, 14.5}}) {
        const CameraView view = camera_view(lens);
        for (int i = 0; i < lens.width * lens.height; ++i) {
            ASSERT_EQ(view.pixel_of(2.5f * view.rays->pixels[std::size_t(i)]), i);
        }
    }
}

TEST(CameraView, PointsOutOfSightHaveNoPixel) {
    const CameraView view = camera_view(bent_lens());
    EXPECT_EQ(view.pixel_of({0, 0, -1}), -1);
    EXPECT_EQ(view.pixel_of({0, 0, 0}), -1);
    EXPECT_EQ(view.pixel_of({3, 0, 1}), -1);  // the distortion's polynomial alone folds it back
}

TEST(SurfaceFromDepth, NormalsOfABallPointOutAndTowardsTheCamera) {
    const Lens lens = test::small_lens();
    const Image<float> depth = test::room_depth(lens, Pose{});
    const SurfaceMap surface = surface_from_depth(depth, lens, Pose{});
    const test::Ball& ball = test::balls[0];
    int tested = 0;
    for (std::size_t i = 0; i < surface.position.pixels.size(); ++i) {
        const glm::vec3 out = surface.position.pixels[i] - glm::vec3(ball.centre);
        if (std::abs(glm::length(out) - ball.radius) > 1e-4) continue;
        const glm::vec3 n = glm::normalize(out);
        if (-glm::dot(n, glm::normalize(surface.position.pixels[i])) < 0.5f) continue;
        ++tested;
        // Slopes over 4 px = 4 cm on a ball of 40 cm: their mean errs by its curvature's change.
        EXPECT_GT(glm::dot(n, surface.normal.pixels[i]), 0.99f);
        EXPECT_LT(glm::dot(surface.normal.pixels[i], surface.position.pixels[i]), 0);
    }
    EXPECT_GT(tested, 500);
}

TEST(SurfaceFromDepth, AGrazingSurfaceHasItsNormal) {
    const SurfaceMap surface =
        surface_from_depth(grazing_face(quarter_lens, 30, 42), quarter_lens, Pose{});
    // z = 0.2 / (0.25 - x / z) is the plane 0.25 z - x = 0.2.
    const glm::vec3 normal = glm::normalize(glm::vec3(1, 0, -0.25f));
    for (int y = 1; y < 59; ++y) {
        for (int x = 31; x < 41; ++x)  // 1e-4: rounding of float depths over two pixels
            ASSERT_GT(glm::dot(surface.normal(x, y), normal), 1 - 1e-4f) << x << ", " << y;
    }
}

TEST(SurfaceFromDepth, PositionsAppearAtTheirPixelsThroughABentLens) {
    const Lens lens = bent_lens();
    const SurfaceMap surface =
        surface_from_depth(Image<float>(lens.width, lens.height, 1.7f), lens, Pose{});
    for (int y = 0; y < lens.height; y += 37) {
        for (int x = 0; x < lens.width; x += 41) {  // 1e-3 px: positions are floats
            EXPECT_LT(glm::length(project(lens, surface.position(x, y)) - glm::dvec2(x, y)), 1e-3);
        }
    }
}

}  // namespace
}  // namespace inlay
