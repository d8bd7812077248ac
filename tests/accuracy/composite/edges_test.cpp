// Where real things stand before virtual ones: how far the cut is from the true one.
#include "composite/accuracy/built_in_works.h"
#include "composite/accuracy/unit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

namespace inlay {
namespace {

namespace fs = std::filesystem;

/// M, from 64 camera rays per pixel.
Image<float> coverage(const Work& work, const TrackedFrame& frame) {
    SamplingSettings sampling;
    sampling.primary = sampling.secondary = 1;
    sampling.coverage = 64;
    return sample_frame(work, frame, sampling, 0).result.layers.m;
}

/// Pixels that virtual objects would cover whole, were nothing real before them.
std::vector<bool> covered_alone(const Work& work, TrackedFrame frame) {
    frame.geometry = no_real_geometry();
    std::vector<bool> result;
    for (const float m : coverage(work, frame).pixels)
        result.push_back(m == 0);
    return result;
}

/// The area between an edge and the true one per length of the true one (px), inside virtual
/// objects. Sides of pixels follow a slanted line at 4 / pi of its length, in the mean.
double boundary_error(const Image<float>& m, const Image<float>& truth,
                      const std::vector<bool>& inside) {
    double area = 0, sides = 0;
    const auto compare = [&](std::size_t a, std::size_t b) {
        sides += inside[a] && inside[b] && (truth.pixels[a] > 0.5f) != (truth.pixels[b] > 0.5f);
    };
    for (int y = 0; y + 1 < m.height; ++y) {
        for (int x = 0; x + 1 < m.width; ++x) {
            const std::size_t i = m.index(x, y);
            compare(i, m.index(x + 1, y));
            compare(i, m.index(x, y + 1));
            if (inside[i]) area += std::abs(double(m.pixels[i] - truth.pixels[i]));
        }
    }
    EXPECT_GT(sides, 40);  // else hardly anything is cut
    return area / (sides * 3.14159 / 4);
}

TEST(Edges, TheCutBehindRealThingsFollowsThePhotograph) {
    const fs::path folder = fs::temp_directory_path() / fmt::format("inlay_edges_{}", getpid());
    const Work work = built_in_work("edges", fs::path(INLAY_SOURCE_DIR) / "apps" / "scenes", folder,
                                    {{320, 240}, 10, 32, 2, {7}});
    Settings settings, as_depth_has_them;
    as_depth_has_them.slam.edges.reach = 0;
    const TrackedFrame after = track_frames(work, {7}, settings).at(0);
    const TrackedFrame before = track_frames(work, {7}, as_depth_has_them).at(0);
    const TrackedFrame exact = with_true_room(work, after, true_pose(work, 7));
    const Image<float> truth = coverage(work, exact);
    const std::vector<bool> inside = covered_alone(work, exact);
    const double error_before = boundary_error(coverage(work, before), truth, inside);
    const double error_after = boundary_error(coverage(work, after), truth, inside);
    RecordProperty("before_px", fmt::format("{:.2f}", error_before));
    RecordProperty("after_px", fmt::format("{:.2f}", error_after));
    // The sensor loses depth at edges, a pixel wide. What remains is the rim of the mug's far side
    // and the book's far edge, which stand off what is behind them by less than edges are seen by.
    EXPECT_GT(error_before, 0.7);
    EXPECT_LT(error_after, 0.6 * error_before);
    EXPECT_LT(error_after, 0.6);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace inlay
