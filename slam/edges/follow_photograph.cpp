#include "slam/edges/follow_photograph.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"
#include "slam/depth/camera_view.h"
#include "slam/edges/edge_band.h"
#include "slam/edges/two_sides.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace inlay {
namespace {

constexpr float least_share = 0.06f;  // of a pixel; less of a second surface is not kept
constexpr int smear = 100;            // the image's width over what sensors smear depth steps by
constexpr float noise = 0.02f;        // of encoded color, 0..1
constexpr float cost_of_way = 0.1f;   // of samples at the window's border, in squared misfits

/// What a pixel of the band turned out to see.
struct Verdict {
    bool known = false, two_sides = false;
    OwnSide own = OwnSide::unknown;
    float near_share = 1;           // 0..1 of the pixel
    std::size_t near = 0, far = 0;  // pixels whose planes it sees
};

/// A pixel's encoded color, 0..1.
glm::vec3 color_at(const Image<EncodedRgb>& photo, std::size_t pixel) {
    const EncodedRgb& c = photo.pixels[pixel];
    return glm::vec3(c.r, c.g, c.b) / 255.0f;
}

/// Where a color lies between those of a near and a far sample.
struct Mixture {
    float share = 0.5f;  // of the near one
    float contrast = 0;  // distance of the two colors
    float misfit = std::numeric_limits<float>::max();
};

/// Wang and Cohen 2007, eq. 1 and 2.
Mixture mixture_of(const glm::vec3& color, const glm::vec3& near, const glm::vec3& far) {
    const glm::vec3 span = near - far;
    const float length2 = glm::dot(span, span);
    Mixture result;
    result.contrast = std::sqrt(length2);
    if (length2 > 0) result.share = std::clamp(glm::dot(color - far, span) / length2, 0.0f, 1.0f);
    const glm::vec3 off = color - (far + result.share * span);
    result.misfit = glm::dot(off, off) / (noise * noise + length2);
    return result;
}

/// The mixture of two near-by samples, one of each side, that fits a color best.
Mixture best_mixture(const Image<EncodedRgb>& photo, std::size_t pixel, const TwoSides& sides) {
    constexpr float window2 = SideFinder::window * SideFinder::window;
    const glm::vec3 color = color_at(photo, pixel);
    Mixture best;
    for (std::size_t i = 0; i < std::size_t(sides.near.count); ++i) {
        const glm::vec3 near = color_at(photo, sides.near.pixel[i]);
        for (std::size_t j = 0; j < std::size_t(sides.far.count); ++j) {
            Mixture mixture = mixture_of(color, near, color_at(photo, sides.far.pixel[j]));
            const float way = sides.near.distance2[i] + sides.far.distance2[j];
            mixture.misfit += cost_of_way * way / window2;
            if (mixture.misfit < best.misfit) best = mixture;
        }
    }
    return best;
}

Verdict judge(const Image<EncodedRgb>& photo, int band, const TwoSides& sides, std::size_t pixel,
              float least_contrast) {
    Verdict verdict;
    verdict.known = sides.near.count > 0;
    verdict.two_sides = verdict.known && sides.far.count > 0;
    verdict.own = sides.own;
    if (verdict.known) verdict.near = sides.near.pixel[0];
    if (!verdict.two_sides) return verdict;
    verdict.far = sides.far.pixel[0];
    const bool measured = sides.own != OwnSide::unknown;
    const bool was_near =
        measured ? sides.own == OwnSide::near : sides.near.distance2[0] < sides.far.distance2[0];
    const Mixture mixture = best_mixture(photo, pixel, sides);
    float trust = std::clamp(mixture.contrast / least_contrast - 1, 0.0f, 1.0f);
    if (measured) {  // depth is wrong by a few pixels at most
        const float depth_trust = sides.from_edge / float(band + 1);
        trust *= 1 - depth_trust * depth_trust;
    }
    verdict.near_share = glm::mix(was_near ? 1.0f : 0.0f, mixture.share, trust);
    return verdict;
}

/// Puts the surfaces of pixels where the verdicts see them.
class Mover {
public:
    Mover(const SurfaceMap& map, const Image<std::uint8_t>& band, const Image<Verdict>& verdicts)
        : before_(map), band_(band), verdicts_(verdicts), view_(camera_view(map.lens)) {}

    /// Gives a pixel the surface that fills more of it.
    void move(SurfaceMap& map, int x, int y) const {
        const Verdict& verdict = verdicts_(x, y);
        const std::size_t here = band_.index(x, y);
        const std::size_t from = source(verdict, verdict.near_share >= 0.5f, here);
        map.position.pixels[here] = point_on(from, x, y);
        map.normal.pixels[here] = before_.normal.pixels[from];
        map.confidence.pixels[here] = before_.confidence.pixels[from];
    }

    /// What else a pixel sees, if an edge crosses it.
    std::optional<SecondSurface> second(int x, int y) const {
        const Verdict& verdict = verdicts_(x, y);
        if (!verdict.two_sides) return std::nullopt;
        const bool near = verdict.near_share >= 0.5f;
        const float share = near ? 1 - verdict.near_share : verdict.near_share;
        const glm::vec2 slope = slope_of_share(x, y);
        if (share < least_share || !(glm::dot(slope, slope) > 0)) return std::nullopt;
        const glm::vec2 to_near = glm::normalize(slope);
        const std::size_t other = source(verdict, !near, band_.index(x, y));
        const float across = std::abs(to_near.x) + std::abs(to_near.y);  // px, of the pixel
        return SecondSurface{point_on(other, x, y), before_.normal.pixels[other],
                             near ? -to_near : to_near, (0.5f - share) * across};
    }

private:
    /// The pixel that has the surface of a side: the pixel `here` itself if it is on that side.
    static std::size_t source(const Verdict& verdict, bool near, std::size_t here) {
        if (verdict.own == (near ? OwnSide::near : OwnSide::far)) return here;
        return near ? verdict.near : verdict.far;
    }

    /// The point of a pixel's ray on the plane of `other`, as far as that is flat enough; its own
    /// point, if it is that pixel.
    glm::vec3 point_on(std::size_t other, int x, int y) const {
        const glm::vec3 &p = before_.position.pixels[other], &n = before_.normal.pixels[other];
        if (other == band_.index(x, y) || !(p.z > 0)) return p;
        const glm::vec3 ray = (*view_.rays)(x, y);
        const float z = glm::dot(n, p) / glm::dot(n, ray);
        const bool flat = z > (1 - steepest_plane) * p.z && z < (1 + steepest_plane) * p.z;
        return (flat ? z : p.z) * ray;
    }

    /// How much of a neighbour the near surface of `center` fills.
    float share_at(int x, int y, const Verdict& center) const {
        if (!band_.contains(x, y)) return center.near_share;
        if (band_(x, y) != 0)
            return verdicts_(x, y).known ? verdicts_(x, y).near_share : center.near_share;
        const float z = before_.position(x, y).z;
        const float near = before_.position.pixels[center.near].z;
        const float far = before_.position.pixels[center.far].z;
        if (!(z > 0)) return 0;
        return !(far > 0) || z * z < near * far ? 1.0f : 0.0f;
    }

    /// Its rise (Sobel 1968) towards the near surface.
    glm::vec2 slope_of_share(int x, int y) const {
        const Verdict& center = verdicts_(x, y);
        glm::vec2 slope(0);
        for (int k = -1; k <= 1; ++k) {
            const float weight = k == 0 ? 2 : 1;
            slope.x += weight * (share_at(x + 1, y + k, center) - share_at(x - 1, y + k, center));
            slope.y += weight * (share_at(x + k, y + 1, center) - share_at(x + k, y - 1, center));
        }
        return slope;
    }

    const SurfaceMap before_;
    const Image<std::uint8_t>& band_;
    const Image<Verdict>& verdicts_;
    CameraView view_;
};

/// Moves the edges that are within a band.
void move_edges(SurfaceMap& map, const Image<EncodedRgb>& photo, const BandWidth& width, float step,
                float contrast) {
    const Image<std::uint8_t> band = edge_band(map, width, step);
    const SideFinder finder(map, band);
    Image<Verdict> verdicts(band.width, band.height);
    parallel_rows(band.height, [&](int y) {
        for (int x = 0; x < band.width; ++x) {
            if (band(x, y) == 0) continue;
            verdicts(x, y) =
                judge(photo, band(x, y), finder.around(x, y), band.index(x, y), contrast);
        }
    });
    const Mover mover(map, band, verdicts);
    map.split = {Image<std::uint32_t>(band.width, band.height, 0), {}};
    for (int y = 0; y < band.height; ++y) {
        for (int x = 0; x < band.width; ++x) {
            if (!verdicts(x, y).known) continue;
            mover.move(map, x, y);
            const auto second = mover.second(x, y);
            if (!second) continue;
            map.split.second.push_back(*second);
            map.split.number(x, y) = std::uint32_t(map.split.second.size());
        }
    }
}

}  // namespace

void validate(const EdgeSettings& s) {
    require(s.reach >= 0 && s.reach <= 1, "slam.edges.reach must be 0..1 m", ExitCode::usage);
    require(s.step > 0 && s.step < 1, "slam.edges.step must lie in (0, 1)", ExitCode::usage);
    require(s.contrast > 0 && s.contrast <= 1, "slam.edges.contrast must lie in (0, 1]",
            ExitCode::usage);
}

void follow_photograph(SurfaceMap& map, const Image<EncodedRgb>& photo,
                       const EdgeSettings& settings) {
    map.split = {};
    if (settings.reach == 0 || photo.empty()) return;
    require(same_size(map.position, photo), "a photograph and its surface map differ in size");
    move_edges(map, photo, {settings.reach, photo.width / smear}, settings.step,
               2 * settings.contrast);
    move_edges(map, photo, {settings.reach, 0}, settings.step, settings.contrast);
}

}  // namespace inlay
