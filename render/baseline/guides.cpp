#include "render/baseline/guides.h"

#include "recordings/base/color.h"
#include "recordings/base/parallel.h"
#include "render/baseline/smooth_receivers.h"

#include <algorithm>
#include <limits>
#include <memory>

namespace inlay {
namespace {

constexpr float brightest_guide = 1e15f;

/// 1 / (2 sigma_d^2) per pixel (1/m^2).
Image<float> plane_precision(const FilterPlanes& planes, const glm::dvec3& camera, double share) {
    const auto& p = planes.surface->position;
    Image<float> result(planes.object.width, planes.object.height, 0.0f);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x) {
            if (planes.object(x, y) == 0) continue;
            const double sigma =
                share * glm::distance(camera, glm::dvec3(p[0](x, y), p[1](x, y), p[2](x, y)));
            result(x, y) = float(0.5 / std::max(sigma * sigma, 1e-18));
        }
    });
    return result;
}

void add_surface_exponents(const SurfacePlanes& s, const Image<float>& precision, float turning,
                           const PairRun& run, float* __restrict exponents) {
    const std::size_t a = precision.index(run.x, run.y);
    const std::size_t b = precision.index(run.x + run.tap.dx, run.y + run.tap.dy);
    const float *px = s.position[0].pixels.data(), *py = s.position[1].pixels.data(),
                *pz = s.position[2].pixels.data();
    const float *nx = s.normal[0].pixels.data(), *ny = s.normal[1].pixels.data(),
                *nz = s.normal[2].pixels.data();
    const float* offset = precision.pixels.data() + a;
    for (int k = 0; k < run.count; ++k) {
        const std::size_t i = a + std::size_t(k), j = b + std::size_t(k);
        const float u = nx[j] - nx[i], v = ny[j] - ny[i], w = nz[j] - nz[i];
        const float off =
            nx[i] * (px[j] - px[i]) + ny[i] * (py[j] - py[i]) + nz[i] * (pz[j] - pz[i]);
        exponents[k] += turning * (u * u + v * v + w * w) + offset[k] * off * off;
    }
}

}  // namespace

void validate(const SurfaceGuide& guide) {
    require_width(guide.normal_sigma, "the guide's normal_sigma");
    require_width(guide.depth_share, "the guide's depth_share");
}

AddExponents surface_exponents(const FilterPlanes& planes, const glm::dvec3& camera_position,
                               const SurfaceGuide& guide) {
    const auto precision = std::make_shared<const Image<float>>(
        plane_precision(planes, camera_position, guide.depth_share));
    const auto turning = float(0.5 / (guide.normal_sigma * guide.normal_sigma));
    return [surface = planes.surface, precision, turning](const PairRun& run, float* exponents) {
        add_surface_exponents(*surface, *precision, turning, run, exponents);
    };
}

Image<float> guide_luminance(const FilterPlanes& planes) {
    const std::size_t red = planes.channels.size() - 3;
    Image<float> result(planes.object.width, planes.object.height, 0.0f);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x) {
            const Rgb c{planes.channels[red](x, y), planes.channels[red + 1](x, y),
                        planes.channels[red + 2](x, y)};
            result(x, y) = std::clamp(luminance(c), -brightest_guide, brightest_guide);
        }
    });
    return result;
}

Image<float> local_variance(const Image<std::uint32_t>& object, const Image<float>& luminance,
                            const AddExponents& add_exponents) {
    Image<float> squares = luminance;
    for (float& l : squares.pixels)
        l *= l;
    const std::vector<Tap> taps = gaussian_taps(3, std::numeric_limits<double>::infinity());
    const Means means = weighted_means(object, {luminance, squares}, nullptr, taps, add_exponents);
    Image<float> result(object.width, object.height, 0.0f);
    for (std::size_t i = 0; i < result.pixels.size(); ++i) {
        const float mean = means.channels[0].pixels[i];
        result.pixels[i] = std::max(means.channels[1].pixels[i] - mean * mean, 0.0f);
    }
    return result;
}

}  // namespace inlay
