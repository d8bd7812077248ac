// The two surfaces that meet at an edge, as the pixels around one of its pixels show them.
#pragma once

#include "recordings/base/surface_map.h"

#include <array>
#include <cstdint>
#include <vector>

namespace inlay {

/// Trusted pixels of one surface, nearest first.
struct EdgeSide {
    static constexpr int most = 6;
    std::array<std::size_t, most> pixel{};
    std::array<float, most> distance2{};  // px^2
    int count = 0;
};

/// The side on which a pixel's own depth lies.
enum class OwnSide { unknown, near, far };

struct TwoSides {
    EdgeSide near, far;  // of the nearer surface, and of what lies behind: maybe nothing known
    OwnSide own = OwnSide::unknown;
    float from_edge = 0;  // px to the nearest pixel of another depth; at most its band + 1
};

/// Looks for two surfaces around pixels of a surface map. Surfaces are runs of depth, in classes of
/// 1.25 %, with at least two empty classes between them; pixels without depth are one, behind all.
/// A plane seen so flat that depth grows by 4 % from pixel to pixel counts as several.
class SideFinder {
public:
    /// `band`: as edge_band(); pixels outside it are trusted. Both must outlive the finder.
    SideFinder(const SurfaceMap& map, const Image<std::uint8_t>& band);

    /// The sides around a pixel of the band: of a pixel with depth, the surface it lies on and the
    /// nearest other one; of a hole, the two nearest. The far one is empty where there is no other;
    /// both are where a pixel has a depth that no trusted one has: a thing too thin to tell.
    TwoSides around(int x, int y) const;
    /// How far (px) samples are looked for.
    static constexpr int window = 10;

private:
    /// A pixel near another.
    struct Step {
        glm::ivec2 by{0};   // px
        int distance2 = 0;  // px^2
    };
    /// Classes of depth of one surface.
    struct Run {
        std::uint8_t first = 1, last = 0;  // empty
        bool holds(int depth_class) const { return depth_class >= first && depth_class <= last; }
    };
    static constexpr std::size_t most_runs = 4;
    using Runs = std::array<Run, most_runs>;  // nearest first

    static std::vector<Step> steps_within(int reach, int stride);
    bool asked(int x, int y) const;
    Runs runs_around(int x, int y) const;
    float from_edge(int x, int y, const Run& own) const;

    const Image<std::uint8_t>& band_;
    Image<std::uint8_t> depth_class_;
    Image<Runs> runs_;                          // of tiles
    std::vector<Step> window_, sparse_, near_;  // nearest first: all, every second, up to a band
};

}  // namespace inlay
