#include "composite/accuracy/displacement.h"

#include "recordings/base/check.h"
#include "render/trace/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace inlay {
namespace {

/// A pixel's share in a difference, which is linear in the pixels.
struct Tap {
    std::size_t pixel = 0;
    float weight = 0;
};

/// What a picture moved by `shift` px along both axes shows at (x, y), bilinear with its border
/// repeated, less what it showed there.
std::array<Tap, 5> taps_at(const Image<Rgb>& image, int x, int y, double shift) {
    const int whole = int(std::floor(shift));
    const auto part = float(shift - whole);
    std::array<Tap, 5> taps{{{image.index(x, y), -1}}};
    for (int k = 0; k < 4; ++k) {
        const int u = std::clamp(x + whole + k % 2, 0, image.width - 1);
        const int v = std::clamp(y + whole + k / 2, 0, image.height - 1);
        const float weight = (k % 2 == 1 ? part : 1 - part) * (k / 2 == 1 ? part : 1 - part);
        const Tap tap{image.index(u, v), weight};
        for (Tap& known : taps) {  // one pixel's noise counts once
            if (known.weight != 0 && known.pixel != tap.pixel) continue;
            known = {tap.pixel, known.weight + tap.weight};
            break;
        }
    }
    return taps;
}

}  // namespace

double displacement_px(const Work& work, const TrackedFrame& frame, const Pose& true_pose) {
    require(work.knows_room && frame.room != nullptr, work.name + ": its true room is unknown");
    const EmbreeScene room = EmbreeSceneCache().place(work.scene, frame.time, /*real=*/true);
    const Image<float> depth = trace_depth(room, frame.lens, true_pose);
    const SurfaceMap& surface = *frame.room->surface;
    // Where a true point is seen from the pose that was found, and how far the model's depth moves
    // what it casts: a length on the surface is as long in the image as one across the view.
    double sum = 0;
    int count = 0;
    for (int y = 0; y < depth.height; ++y) {
        for (int x = 0; x < depth.width; ++x) {
            const float z = depth(x, y);
            if (z <= 0 || !surface.has_surface(x, y)) continue;
            const glm::dvec3 world = true_pose * (double(z) * unproject(frame.lens, {x, y}));
            const glm::dvec3 seen = inverse(frame.world_from_camera) * world;
            if (!(seen.z > 0)) continue;
            const double off = glm::length(project(frame.lens, seen) - glm::dvec2(x, y));
            const double error = double(surface.position(x, y).z) - seen.z;
            if (std::abs(error) > 0.05 * double(z)) continue;  // another surface: an edge
            const double cast = frame.lens.fx * std::abs(error) / double(z);
            sum += off * off + cast * cast;
            ++count;
        }
    }
    return count > 0 ? std::sqrt(sum / count) : 0;
}

double displaced_mean_square(const Reference& truth, double px) {
    const double shift = px / std::sqrt(2.0);
    const Image<Rgb>& image = truth.linear;
    double sum = 0;
    std::size_t count = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            if (truth.influenced(x, y) == 0) continue;
            Rgb difference(0);
            double variance = 0;
            bool known = true;
            for (const Tap& tap : taps_at(image, x, y, shift)) {
                if (tap.weight == 0) continue;
                known = known && truth.finite.pixels[tap.pixel] != 0;
                difference += tap.weight * image.pixels[tap.pixel];
                const Rgb error = tap.weight * truth.standard_error.pixels[tap.pixel];
                variance += double(glm::dot(error, error));
            }
            if (!known) continue;
            sum += double(glm::dot(difference, difference)) - variance;
            ++count;
        }
    }
    return count > 0 ? std::max(0.0, sum / (3.0 * double(count))) : 0.0;
}

}  // namespace inlay
