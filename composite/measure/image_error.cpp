#include "composite/measure/image_error.h"

#include "composite/measure/masked_mean.h"
#include "recordings/base/check.h"

#include <cmath>
#include <limits>

namespace inlay {
namespace {

struct SquaredSums {
    double difference = 0, reference = 0;
    std::uint64_t pixels = 0, non_finite = 0;
};

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

double square(const glm::dvec3& v) { return glm::dot(v, v); }

SquaredSums squared_sums(const Image<Rgb>& image, const Image<Rgb>& reference, const Mask& mask) {
    SquaredSums sums;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (!counts(mask, i)) continue;
        const Rgb& a = image.pixels[i];
        const Rgb& b = reference.pixels[i];
        if (!finite(a) || !finite(b)) {
            ++sums.non_finite;
            continue;
        }
        sums.difference += square(glm::dvec3(a) - glm::dvec3(b));
        sums.reference += square(glm::dvec3(b));
        ++sums.pixels;
    }
    return sums;
}

double ratio_of(double error, double reference) {
    if (error == 0) return 0;
    return reference > 0 ? error / reference : std::numeric_limits<double>::infinity();
}

}  // namespace

RadianceError radiance_error(const Image<Rgb>& image, const Image<Rgb>& reference,
                             const Mask& mask) {
    check_comparable(image, reference, mask);
    const SquaredSums sums = squared_sums(image, reference, mask);
    require(sums.pixels > 0, "no pixel can be compared: none is counted and finite in both");
    RadianceError error;
    error.pixels = sums.pixels;
    error.non_finite = sums.non_finite;
    error.rmse = std::sqrt(sums.difference / double(3 * sums.pixels));
    error.relative_rmse = ratio_of(error.rmse, std::sqrt(sums.reference / double(3 * sums.pixels)));
    return error;
}

double psnr(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference, const Mask& mask) {
    check_comparable(image, reference, mask);
    const double mean_square = masked_mean(image, mask, [&](std::size_t i) {
        const EncodedRgb& a = image.pixels[i];
        const EncodedRgb& b = reference.pixels[i];
        return square(glm::dvec3(a.r - b.r, a.g - b.g, a.b - b.b)) / 3;
    });
    if (mean_square == 0) return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255.0 / mean_square);
}

double ssim(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference, const Mask& mask) {
    check_comparable(image, reference, mask);
    const Image<float> map = ssim_map(image, reference);
    return masked_mean(map, mask, [&](std::size_t i) { return double(map.pixels[i]); });
}

double flip(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference, const Mask& mask,
            const FlipSettings& settings) {
    check_comparable(image, reference, mask);
    const Image<float> map = flip_map(image, reference, settings);
    return masked_mean(map, mask, [&](std::size_t i) { return double(map.pixels[i]); });
}

DisplayError display_error(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
                           const Mask& mask) {
    return {psnr(image, reference, mask), ssim(image, reference, mask),
            flip(image, reference, mask)};
}

}  // namespace inlay
