// The two surfaces that meet at an edge, as the pixels around one of its pixels show them.
#pragma once

#include "recordings/base/surface_map.h"

#include <array>
#include <cstdint>
#include <vector>

namespace inlay {

/// A pixel near another.
struct NearbyPixel {
    glm::ivec2 step{0};  // px, to it
    int distance2 = 0;   // px^2
};

/// Pixels of one side, nearest first.
struct EdgeSide {
    static constexpr int most = 6;
    std::array<std::size_t, most> pixel{};
    std::array<float, most> distance2{};  // px^2
    int count = 0;
};

struct TwoSides {
    EdgeSide near, far;   // pixels that can be trusted; of the nearer surface, of what lies behind
    bool in_near = true;  // whether the pixel's own depth, if any, belongs to the nearer surface
    float from_edge = 0;  // px to where depth changes sides; at most `band` + 1
};

/// Looks for two surfaces around pixels of a surface map. Depth is compared in classes of 2.5 %;
/// pixels without any count as what lies behind.
class SideFinder {
public:
    /// `band`: as edge_band(); pixels outside it are trusted. Both must outlive the finder.
    SideFinder(const SurfaceMap& map, const Image<std::uint8_t>& band);

    /// The sides around a pixel of the band; the far one is empty where there is no gap in depth.
    TwoSides around(int x, int y) const;
    /// How far (px) samples are looked for.
    static constexpr int window = 10;

private:
    int find_parting(int x, int y) const;
    float from_edge(int x, int y, int parting) const;

    const Image<std::uint8_t>& band_;
    Image<std::uint8_t> depth_class_;
    Image<std::uint8_t> parting_;              // of tiles: the class at which the far side begins
    std::vector<NearbyPixel> sparse_, dense_;  // nearest first; every second pixel, and every one
};

}  // namespace inlay
