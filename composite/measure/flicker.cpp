#include "composite/measure/flicker.h"

#include "composite/measure/masked_mean.h"
#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

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
    const Image<Rgb>& reference = now.truth.empty() ? now.picture : now.truth;
    for (std::size_t i = 0; i < now.picture.pixels.size(); ++i) {
        if (!counts(mask, i)) continue;
        const glm::dvec3 change = (pixel(now.picture, i) - pixel(now.truth, i)) -
                                  (pixel(before.picture, i) - pixel(before.truth, i));
        if (!finite(change)) {
            ++sums.non_finite;
            continue;
        }
        const glm::dvec3 value = pixel(reference, i);
        sums.change += glm::dot(change, change);
        sums.reference += glm::dot(value, value);
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
    if (sums.change > 0)
        flicker.relative = sums.reference > 0 ? std::sqrt(sums.change / sums.reference)
                                              : std::numeric_limits<double>::infinity();
    return flicker;
}

Mask steady_pixels(const Image<Rgb>& truth_before, const Image<Rgb>& truth_now,
                   double largest_change) {
    check_comparable(truth_before, truth_now);
    Mask steady(truth_now.width, truth_now.height);
    for (std::size_t i = 0; i < steady.pixels.size(); ++i) {
        const glm::dvec3 change = glm::abs(pixel(truth_now, i) - pixel(truth_before, i));
        steady.pixels[i] =
            finite(change) && std::max({change.x, change.y, change.z}) <= largest_change;
    }
    return steady;
}

}  // namespace inlay
