#include "slam/edges/edge_band.h"

#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>

namespace inlay {
namespace {

constexpr float far_factor = 2.5f;  // times the reach

bool off_plane(const SurfaceMap& map, std::size_t at, std::size_t other, float step) {
    const glm::vec3& p = map.position.pixels[at];
    const glm::vec3 between = map.position.pixels[other] - p;
    return std::abs(glm::dot(map.normal.pixels[at], between)) > step * p.z;
}

/// Whether a depth step or the border of a hole runs between two neighbours.
bool edge_between(const SurfaceMap& map, std::size_t a, std::size_t b, float step) {
    const bool seen = map.position.pixels[a].z > 0;
    if (seen != (map.position.pixels[b].z > 0)) return true;
    return seen && off_plane(map, a, b, step) && off_plane(map, b, a, step);
}

/// The band's half-width (px) at a pixel that lies at an edge: by the nearer one of two surfaces.
int width_at(const SurfaceMap& map, std::size_t a, std::size_t b, const BandWidth& width) {
    const float za = map.position.pixels[a].z, zb = map.position.pixels[b].z;
    const float z = za > 0 && zb > 0 ? std::min(za, zb) : std::max(za, zb);
    const float pixels = width.reach * float(map.lens.fx) / z;
    const int far = std::min(int(std::ceil(far_factor * pixels)), width.smear);
    return std::clamp(std::max(int(std::ceil(pixels)), far), 1, widest_band);
}

/// What is left (px) of the band's half-width `full` at a pixel.
struct Width {
    std::uint8_t left = 0, full = 0;
};

/// The half-widths at the pixels that lie at an edge.
Image<Width> width_of_edges(const SurfaceMap& map, const BandWidth& band, float step) {
    const Lens& lens = map.lens;
    Image<Width> widths(lens.width, lens.height);
    parallel_rows(lens.height, [&](int y) {
        for (int x = 0; x < lens.width; ++x) {
            const std::size_t here = map.position.index(x, y);
            int width = 0;
            for (const glm::ivec2 n : {glm::ivec2(x + 1, y), glm::ivec2(x - 1, y),
                                       glm::ivec2(x, y + 1), glm::ivec2(x, y - 1)}) {
                if (!map.position.contains(n.x, n.y)) continue;
                const std::size_t there = map.position.index(n.x, n.y);
                if (!edge_between(map, here, there, step)) continue;
                width = std::max(width, width_at(map, here, there, band));
            }
            widths(x, y) = {std::uint8_t(width), std::uint8_t(width)};
        }
    });
    return widths;
}

/// Spreads half-widths by chessboard distance (Rosenfeld and Pfaltz 1966).
void spread(Image<Width>& widths) {
    const auto take = [&](int x, int y, int i, int j) {
        if (!widths.contains(i, j)) return;
        const Width other = widths(i, j);
        Width& own = widths(x, y);
        if (other.left > own.left + 1) own = {std::uint8_t(other.left - 1), other.full};
    };
    for (int y = 0; y < widths.height; ++y) {
        for (int x = 0; x < widths.width; ++x) {
            take(x, y, x - 1, y), take(x, y, x, y - 1);
            take(x, y, x - 1, y - 1), take(x, y, x + 1, y - 1);
        }
    }
    for (int y = widths.height - 1; y >= 0; --y) {
        for (int x = widths.width - 1; x >= 0; --x) {
            take(x, y, x + 1, y), take(x, y, x, y + 1);
            take(x, y, x + 1, y + 1), take(x, y, x - 1, y + 1);
        }
    }
}

}  // namespace

Image<std::uint8_t> edge_band(const SurfaceMap& map, const BandWidth& width, float step) {
    Image<Width> widths = width_of_edges(map, width, step);
    spread(widths);
    Image<std::uint8_t> band(widths.width, widths.height, 0);
    for (std::size_t i = 0; i < band.pixels.size(); ++i)
        band.pixels[i] = widths.pixels[i].full;
    return band;
}

}  // namespace inlay
