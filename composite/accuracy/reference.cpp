#include "composite/accuracy/reference.h"

#include "recordings/base/check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace inlay {
namespace {

constexpr float visible_change = 0.004f;  // relative radiance
constexpr float significant = 6;          // standard errors
constexpr double largest_psnr = 100;      // dB

bool finite(const Rgb& c) { return std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b); }

double squared_length(const Rgb& c) { return double(glm::dot(c, c)); }

/// Mean over the channels of the masked pixels of `square(i)`, a sum over channels.
template <class Square>
double mean_over(const Mask& mask, const Square& square) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < mask.pixels.size(); ++i) {
        if (mask.pixels[i] == 0) continue;
        sum += square(i);
        ++count;
    }
    return count > 0 ? sum / (3.0 * double(count)) : 0.0;
}

double variance_over(const Reference& reference, const Mask& mask) {
    return mean_over(
        mask, [&](std::size_t i) { return squared_length(reference.standard_error.pixels[i]); });
}

double mean_square_without_noise(const Reference& reference, const Image<Rgb>& linear,
                                 const Mask& mask) {
    const double rmse = radiance_error(linear, reference.linear, mask).rmse;
    return std::max(0.0, rmse * rmse - variance_over(reference, mask));
}

bool any(const Mask& mask) {
    return std::any_of(mask.pixels.begin(), mask.pixels.end(), [](auto m) { return m != 0; });
}

}  // namespace

Reference make_reference(Image<Rgb> linear, Image<Rgb> standard_error, const Image<Rgb>& without) {
    require(same_size(linear, standard_error) && same_size(linear, without),
            "reference: its picture is " + std::to_string(linear.width) + " x " +
                std::to_string(linear.height) + " px, what it is compared with " +
                std::to_string(without.width) + " x " + std::to_string(without.height) + " px");
    Reference result{std::move(linear), std::move(standard_error),
                     Mask(without.width, without.height), Mask(without.width, without.height), 0};
    for (std::size_t i = 0; i < without.pixels.size(); ++i) {
        const Rgb& value = result.linear.pixels[i];
        const Rgb& error = result.standard_error.pixels[i];
        if (!finite(value) || !finite(error)) {
            ++result.left_out;
            result.linear.pixels[i] = result.standard_error.pixels[i] = Rgb(0);
            continue;
        }
        result.finite.pixels[i] = 1;
        const float change = luminance(glm::abs(value - without.pixels[i]));
        result.influenced.pixels[i] = change > visible_change + significant * luminance(error);
    }
    return result;
}

Reference mean_of_halves(const Image<Rgb>& a, const Image<Rgb>& b, const Image<Rgb>& without) {
    Image<Rgb> mean = a, error = a;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        mean.pixels[i] = 0.5f * (a.pixels[i] + b.pixels[i]);
        error.pixels[i] = 0.5f * glm::abs(a.pixels[i] - b.pixels[i]);
    }
    return make_reference(std::move(mean), std::move(error), without);
}

FrameError error_against(const Reference& reference, const Image<Rgb>& linear,
                         const Image<EncodedRgb>& display) {
    require(any(reference.finite), "reference: no pixel of it is finite");
    const DisplayError seen = display_error(display, encode(reference.linear), reference.finite);
    FrameError error;
    error.mean_square = mean_square_without_noise(reference, linear, reference.finite);
    error.influenced = any(reference.influenced);
    if (error.influenced)
        error.mean_square_influenced =
            mean_square_without_noise(reference, linear, reference.influenced);
    error.reference_power = mean_over(reference.finite, [&](std::size_t i) {
        return squared_length(reference.linear.pixels[i]);
    });
    error.psnr = std::min(seen.psnr, largest_psnr);
    error.ssim = seen.ssim;
    error.flip = seen.flip;
    return error;
}

double mean_square_beyond_noise(const Image<Rgb>& picture, const Image<Rgb>& a, const Image<Rgb>& b,
                                const Mask& mask) {
    require(same_size(picture, a) && same_size(picture, b) && same_size(picture, mask),
            "two estimates, what they are compared with and the mask must have one size");
    return mean_over(mask, [&](std::size_t i) {
        const Rgb& p = picture.pixels[i];
        return double(glm::dot(a.pixels[i] - p, b.pixels[i] - p));
    });
}

double influenced_variance(const Reference& reference) {
    return variance_over(reference, reference.influenced);
}

double influenced_standard_error(const Reference& reference) {
    return std::sqrt(influenced_variance(reference));
}

}  // namespace inlay
