// LDR-FLIP (Andersson et al. 2020). Symbols and constants as there.
#include "composite/measure/image_error.h"
#include "composite/measure/masked_mean.h"
#include "composite/measure/separable.h"
#include "recordings/base/check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace inlay {
namespace {

using Planes = std::array<Image<double>, 3>;

constexpr double q_c = 0.7;              // exponent of the color difference
constexpr double p_c = 0.4;              // share of the largest difference that is mapped ...
constexpr double p_t = 0.95;             // ... to this error
constexpr double q_f = 0.5;              // exponent of the feature difference
constexpr double feature_width = 0.082;  // degrees, of the edges that are looked for

/// A contrast sensitivity in space: the sum of a_i sqrt(pi / b_i) exp(-pi^2 x^2 / b_i), x in
/// degrees (Table 1).
struct Sensitivity {
    std::array<double, 2> a, b;
};
constexpr std::array<Sensitivity, 3> sensitivities{
    {{{1.0, 0.0}, {0.0047, 1e-5}}, {{1.0, 0.0}, {0.0053, 1e-5}}, {{34.1, 13.5}, {0.04, 0.025}}}};
constexpr double largest_b = 0.04;

/// sRGB primaries, D65: columns are the XYZ of red, green and blue.
const glm::dmat3 xyz_from_rgb{{0.4123908, 0.2126390, 0.0193308},
                              {0.3575843, 0.7151687, 0.1191948},
                              {0.1804808, 0.0721923, 0.9505322}};
const glm::dmat3 rgb_from_xyz = glm::inverse(xyz_from_rgb);
const glm::dvec3 white = xyz_from_rgb * glm::dvec3(1);

glm::dvec3 ycxcz_from_rgb(const glm::dvec3& rgb) {
    const glm::dvec3 n = xyz_from_rgb * rgb / white;
    return {116 * n.y - 16, 500 * (n.x - n.y), 200 * (n.y - n.z)};
}

glm::dvec3 rgb_from_ycxcz(const glm::dvec3& c) {
    const double y = (c.x + 16) / 116;
    return rgb_from_xyz * (glm::dvec3(y + c.y / 500, y, y - c.z / 200) * white);
}

double lab_curve(double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
}

/// CIELAB with the Hunt effect: chroma shrinks with lightness (eq. 5).
glm::dvec3 hunt_lab_from_rgb(const glm::dvec3& rgb) {
    const glm::dvec3 n = xyz_from_rgb * rgb / white;
    const double y = lab_curve(n.y);
    const double lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (lab_curve(n.x) - y),
            0.01 * lightness * 200 * (y - lab_curve(n.z))};
}

/// HyAB distance (eq. 6) to the power q_c.
double color_distance(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 d = a - b;
    return std::pow(std::abs(d.x) + std::hypot(d.y, d.z), q_c);
}

/// Maps color distances to 0..1 (eq. 8): the largest is that of green and blue.
double redistributed(double distance) {
    static const double largest =
        color_distance(hunt_lab_from_rgb({0, 1, 0}), hunt_lab_from_rgb({0, 0, 1}));
    const double knee = p_c * largest;
    if (distance < knee) return p_t / knee * distance;
    return std::min(p_t + (distance - knee) / (largest - knee) * (1 - p_t), 1.0);
}

Planes ycxcz_planes(const Image<EncodedRgb>& image) {
    Planes planes;
    planes.fill(Image<double>(image.width, image.height));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const glm::dvec3 c = ycxcz_from_rgb(glm::dvec3(decode(image.pixels[i])));
        for (int k = 0; k < 3; ++k)
            planes[std::size_t(k)].pixels[i] = c[k];
    }
    return planes;
}

/// What the eye resolves of one plane: both Gaussians of its sensitivity, normalised together.
Image<double> resolved(const Image<double>& plane, const Sensitivity& s, double ppd) {
    const int radius =
        int(std::ceil(3 * std::sqrt(largest_b / (2 * std::numbers::pi * std::numbers::pi)) * ppd));
    Image<double> result(plane.width, plane.height, 0.0);
    double total = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        if (s.a[i] == 0) continue;
        const double sigma = std::sqrt(s.b[i] / 2) / std::numbers::pi * ppd;  // px
        const Kernel kernel = gaussian_kernel(sigma, radius);
        double sum = 0;
        for (const double weight : kernel)
            sum += weight;
        const double amplitude = s.a[i] * std::sqrt(std::numbers::pi / s.b[i]);
        const Image<double> part = convolve(plane, kernel, kernel);
        for (std::size_t k = 0; k < part.pixels.size(); ++k)
            result.pixels[k] += amplitude * part.pixels[k];
        total += amplitude * sum * sum;
    }
    for (double& value : result.pixels)
        value /= total;
    return result;
}

/// The picture as seen, in Hunt-adjusted CIELAB (sec. 4.1).
Image<glm::dvec3> seen_colors(const Planes& ycxcz, double ppd) {
    Planes seen;
    for (std::size_t k = 0; k < 3; ++k)
        seen[k] = resolved(ycxcz[k], sensitivities[k], ppd);
    Image<glm::dvec3> result(seen[0].width, seen[0].height);
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        const glm::dvec3 c{seen[0].pixels[i], seen[1].pixels[i], seen[2].pixels[i]};
        result.pixels[i] =
            hunt_lab_from_rgb(glm::clamp(rgb_from_ycxcz(c), glm::dvec3(0), glm::dvec3(1)));
    }
    return result;
}

/// Divides positive weights by their sum and negative ones by theirs.
Kernel balanced(Kernel kernel) {
    double positive = 0;
    double negative = 0;
    for (const double w : kernel)
        (w > 0 ? positive : negative) += std::abs(w);
    for (double& w : kernel)
        if (w != 0) w /= w > 0 ? positive : negative;
    return kernel;
}

/// Strength of edges (first derivative) or points (second derivative) of a plane in 0..1
/// (sec. 4.2.1).
struct Features {
    Image<double> edge, point;
};

Image<double> strength(const Image<double>& plane, const Kernel& derivative, const Kernel& smooth) {
    Image<double> result = convolve(plane, derivative, smooth);
    const Image<double> down = convolve(plane, smooth, derivative);
    for (std::size_t i = 0; i < result.pixels.size(); ++i)
        result.pixels[i] = std::hypot(result.pixels[i], down.pixels[i]);
    return result;
}

Features features_of(Image<double> luminance, double ppd) {
    for (double& value : luminance.pixels)
        value = (value + 16) / 116;
    const double sigma = 0.5 * feature_width * ppd;  // px
    const int radius = int(std::ceil(3 * sigma));
    const Kernel smooth = gaussian_kernel(sigma, radius);
    Kernel first = smooth;
    Kernel second = smooth;
    for (int x = -radius; x <= radius; ++x) {
        first[std::size_t(x + radius)] *= -x;
        second[std::size_t(x + radius)] *= x * x / (sigma * sigma) - 1;
    }
    return {strength(luminance, balanced(first), normalised(smooth)),
            strength(luminance, balanced(second), normalised(smooth))};
}

double feature_difference(const Features& a, const Features& b, std::size_t i) {
    const double edge = std::abs(a.edge.pixels[i] - b.edge.pixels[i]);
    const double point = std::abs(a.point.pixels[i] - b.point.pixels[i]);
    return std::pow(std::max(edge, point) / std::numbers::sqrt2, q_f);
}

}  // namespace

Image<float> flip_map(const Image<EncodedRgb>& image, const Image<EncodedRgb>& reference,
                      const FlipSettings& settings) {
    check_comparable(image, reference);
    const double ppd = settings.pixels_per_degree;
    require(ppd >= 1 && ppd <= 1000, "pixels_per_degree must lie in 1..1000", ExitCode::usage);
    Planes planes_a = ycxcz_planes(image);
    Planes planes_b = ycxcz_planes(reference);
    const Image<glm::dvec3> colors_a = seen_colors(planes_a, ppd);
    const Image<glm::dvec3> colors_b = seen_colors(planes_b, ppd);
    const Features features_a = features_of(std::move(planes_a[0]), ppd);
    const Features features_b = features_of(std::move(planes_b[0]), ppd);
    Image<float> map(image.width, image.height);
    for (std::size_t i = 0; i < map.pixels.size(); ++i) {
        const double color = redistributed(color_distance(colors_a.pixels[i], colors_b.pixels[i]));
        const double feature = feature_difference(features_a, features_b, i);
        map.pixels[i] = float(std::pow(color, 1 - feature));
    }
    return map;
}

}  // namespace inlay
