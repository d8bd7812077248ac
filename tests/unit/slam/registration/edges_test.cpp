// Rims of depth, edges of color, and how rims move with the mapping.
#include "slam/registration/color_edges.h"
#include "slam/registration/color_mapping.h"
#include "slam/registration/depth_edges.h"
#include "slam/registration/match_edge.h"
#include "tests/unit/slam/analytic_room.h"

#include <gtest/gtest.h>

#include <cmath>

namespace inlay {
namespace {

/// A square of 40 px at 1 m, before a wall at 2 m.
Image<float> square_before_wall() {
    Image<float> depth(160, 120, 2.0f);
    for (int y = 40; y < 80; ++y) {
        for (int x = 60; x < 100; ++x)
            depth(x, y) = 1.0f;
    }
    return depth;
}

/// Columns up to `last` dark, the others bright.
ColorEdges step_after(int last) {
    Image<EncodedRgb> color(100, 80, EncodedRgb{200, 180, 160});
    for (int y = 0; y < 80; ++y) {
        for (int x = 0; x <= last; ++x)
            color(x, y) = {40, 60, 80};
    }
    return color_edges(color);
}

SeenRim rim_at(const glm::dvec2& position, const glm::dvec2& normal) {
    SeenRim rim;
    rim.ahead = true;
    rim.position = position;
    rim.normal = normal;
    return rim;
}

TEST(DepthEdges, LieOnTheNearSideAndPointOutwards) {
    const std::vector<DepthEdge> edges = depth_edges(square_before_wall(), 150, {});
    EXPECT_EQ(edges.size(), 4u * 40 - 4);
    for (const DepthEdge& edge : edges) {
        EXPECT_EQ(edge.depth, 1.0f);
        EXPECT_NEAR(glm::length(edge.normal), 1, 1e-5);
        const glm::vec2 from_center = glm::vec2(edge.pixel) - glm::vec2(79.5f, 59.5f);
        EXPECT_NEAR(glm::max(std::abs(from_center.x), std::abs(from_center.y)), 19.5f, 1e-5f);
        EXPECT_GT(glm::dot(edge.normal, from_center), 0);
    }
}

TEST(DepthEdges, BridgeTheProjectorsShadowInRowsOnly) {
    Image<float> depth = square_before_wall();
    for (int y = 0; y < 120; ++y) {  // 150 px * 0.075 m * (1/1 m - 1/2 m) = 5.6 px
        for (int x = 100; x < 110; ++x)
            depth(x, y) = 0;
    }
    const auto count_on_right = [&](float baseline) {
        DepthEdgeSettings settings;
        settings.shadow_baseline = baseline;
        int count = 0;
        for (const DepthEdge& edge : depth_edges(depth, 150, settings))
            count += edge.pixel.x == 99 && edge.pixel.y > 45 && edge.pixel.y < 75;
        return count;
    };
    EXPECT_EQ(count_on_right(0.075f), 29);
    EXPECT_EQ(count_on_right(0), 0);
}

TEST(DepthEdges, ASlopeHasNone) {
    Image<float> depth(160, 120);
    for (int y = 0; y < 120; ++y) {
        for (int x = 0; x < 160; ++x)
            depth(x, y) = 1 + 0.01f * float(x);
    }
    EXPECT_TRUE(depth_edges(depth, 150, {}).empty());
}

TEST(ColorEdges, DirectionsAreClassesOfLines) {
    for (double angle = -6; angle < 6; angle += 0.01) {
        const double x = std::cos(angle), y = std::sin(angle);
        const int direction = edge_direction(x, y);
        EXPECT_GE(direction, 0);
        EXPECT_LT(direction, edge_directions);
        // the opposite is the same line, but rounding may differ at a class's end
        if (std::abs(std::remainder(angle, std::acos(-1.0) / edge_directions)) > 1e-9) {
            EXPECT_EQ(direction, edge_direction(-x, -y));
        }
    }
}

TEST(ColorEdges, TheNearestEdgeIsAsFarAsItIs) {
    const ColorEdges edges = step_after(49);  // the step is at 49.5
    for (const double x : {30.25, 45.0, 58.5}) {
        const auto match = match_edge(edges, rim_at({x, 40.3}, {1, 0}), {});
        ASSERT_TRUE(match);
        EXPECT_NEAR(match->distance, std::abs(x - 49.5), 0.8);  // px: a chain of whole pixels, 1/8
        EXPECT_NEAR(match->direction.x, x < 49.5 ? -1 : 1, 0.13);  // 1/8 px steps
        EXPECT_NEAR(match->direction.y, 0, 1e-9);
    }
    const auto across = match_edge(edges, rim_at({45, 40}, {-0.1, 1}), {});
    ASSERT_TRUE(across);  // 1.67 rad: not of the classes beside that of a vertical edge
    EXPECT_EQ(across->distance, farthest_edge);
}

TEST(ColorEdges, TheCrossedEdgeIsFoundToATenthOfAPixel) {
    const ColorEdges edges = step_after(49);
    for (const double x : {46.0, 48.9, 49.5, 52.2}) {
        const auto match = match_edge(edges, rim_at({x, 40.3}, {1, 0}), {EdgeChoice::crossed, 2});
        ASSERT_TRUE(match);
        EXPECT_NEAR(match->distance, x - 49.5, 0.1);
        EXPECT_EQ(match->direction, glm::dvec2(1, 0));
    }
    EXPECT_FALSE(match_edge(edges, rim_at({70, 40}, {1, 0}), {EdgeChoice::crossed, 2}));
    EXPECT_FALSE(match_edge(edges, rim_at({2, 40}, {1, 0}), {EdgeChoice::crossed, 2}));
}

TEST(ColorMapping, DerivativesAreThoseOfThePosition) {
    const Lens lens{320, 240, 250, 240, 159.5, 119.5, 0.1, -0.05, 0.02, 0.004, -0.003};
    const std::vector<TimedCamera> trajectory{{0, {}},
                                              {1, test::posed({0.2, -0.3, 0.1}, {0.4, 0.1, -0.2})}};
    const ColorMapping mapping{test::posed({0.02, -0.03, 0.01}, {-0.03, 0.004, 0.006}), 0.03, -0.1,
                               0.4};
    const auto position = [&](const ColorMapping& m, const RimPoint& point) {
        return see(mapping_at(m, lens, trajectory, 0.4), point).position;
    };
    for (const glm::dvec3& p : {glm::dvec3(0.3, -0.2, 1.2), {-0.6, 0.4, 2.5}, {0, 0, 0.8}}) {
        const RimPoint point{p, {0.003, -0.002, 0.0001}};
        const FrameMapping frame = mapping_at(mapping, lens, trajectory, 0.4);
        const MappingStep dx = derivative(frame, point, see(frame, point), {1, 0});
        const MappingStep dy = derivative(frame, point, see(frame, point), {0, 1});
        for (std::size_t k = 0; k < MappingParameter::count; ++k) {
            MappingStep up{}, down{};
            up[k] = 1e-4;
            down[k] = -1e-4;
            const glm::dvec2 numeric =
                (position(moved(mapping, up), point) - position(moved(mapping, down), point)) /
                2e-4;
            // central differences err by 1e-8 of the third derivative, up to some 1e3 px
            EXPECT_NEAR(dx[k], numeric.x, 1e-3) << "parameter " << k;
            EXPECT_NEAR(dy[k], numeric.y, 1e-3) << "parameter " << k;
        }
    }
}

TEST(ColorMapping, PointsBehindTheColorCameraAreNotSeen) {
    const FrameMapping behind =
        mapping_at({test::posed({}, {0, 0, -2}), 0, 0, 0}, test::small_lens(), {}, 0);
    EXPECT_FALSE(see(behind, {{0, 0, 1}, {0.01, 0, 0}}).ahead);
}

}  // namespace
}  // namespace inlay
