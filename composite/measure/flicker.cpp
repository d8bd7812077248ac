#include "composite/measure/flicker.h"

#include "composite/measure/masked_mean.h"
#include "recordings/base/check.h"

#include <cmath>
#include <cstddef>

namespace inlay {
namespace {

bool finite(const glm::dvec3& c) {
    return std::isfinite(c.x) && std::isfinite(c.y) && std::isfinite(c.z);
}

glm::dvec3 pixel(const Image<Rgb>& image, std::size_t i) {
    return image.empty() ? glm::dvec3(0) : glm::dvec3(image.pixels[i]);
}

void check_pair(const ShownFrame& before, const ShownFrame& now, const Mask& mask) {
    check_comparable(before.picture, now.picture, mask);
    require(before.truth.empty() == now.truth.empty(),
            "flicker: one of two consecutive frames has a truth, the other none; both or neither "
            "are needed");
    if (now.truth.empty()) return;
    check_comparable(before.picture, before.truth);
    check_comparable(now.picture, now.truth);
}

}  // namespace

void add_flicker(FlickerSums& sums, const ShownFrame& before, const ShownFrame& now,
                 const Mask& mask) {
    check_pair(before, now, mask);
    for (std::size_t i = 0; i < now.picture.pixels.size(); ++i) {
        if (!counts(mask, i)) continue;
        const glm::dvec3 change = (pixel(now.picture, i) - pixel(now.truth, i)) -
                                  (pixel(before.picture, i) - pixel(before.truth, i));
        if (!finite(change)) {
            ++sums.non_finite;
            continue;
        }
        sums.change += glm::dot(change, change);
        ++sums.pixels;
    }
}

Flicker flicker_of(const FlickerSums& sums) {
    require(sums.pixels > 0,
            "flicker: no pixel can be compared: none is counted and finite in two consecutive "
            "frames");
    Flicker flicker;
    flicker.pixels = sums.pixels;
    flicker.non_finite = sums.non_finite;
    flicker.rms = std::sqrt(sums.change / (3.0 * double(sums.pixels)));
    return flicker;
}

}  // namespace inlay
