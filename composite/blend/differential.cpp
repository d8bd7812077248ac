#include "composite/blend/differential.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace inlay {
namespace {

/// The terms of eq. 6.2 at one pixel. Double, so that sums and products of finite floats stay
/// finite.
struct Terms {
    double m = 1;
    glm::dvec3 k_v{0}, s_rv{0}, e_r{0}, e_rv_real{0}, e_rv_virtual{0};
};

struct BlendedPixel {
    Rgb linear{0};
    bool as_recorded = false;
    bool replaced = false;
};

struct RowCounts {
    std::uint64_t virtual_pixels = 0, influenced = 0, replaced = 0;
};

struct RealIrradiance {
    glm::dvec3 sum{0};
    std::uint64_t pixels = 0;
};

glm::dvec3 value_at(const Image<Rgb>& image, std::size_t i) {
    return image.empty() ? glm::dvec3(0) : glm::dvec3(image.pixels[i]);
}

Terms terms_at(const Layers& layers, std::size_t i) {
    const Irradiance& d = layers.direct;
    const Irradiance& n = layers.indirect;
    return {.m = layers.m.pixels[i],
            .k_v = value_at(layers.k_v, i),
            .s_rv = value_at(layers.s_rv, i),
            .e_r = value_at(d.e_r, i) + value_at(n.e_r, i),
            .e_rv_real = value_at(d.e_rv_real, i) + value_at(n.e_rv_real, i),
            .e_rv_virtual = value_at(d.e_rv_virtual, i) + value_at(n.e_rv_virtual, i)};
}

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool finite(const Terms& t) {
    return std::isfinite(t.m) && finite(t.k_v) && finite(t.s_rv) && finite(t.e_r) &&
           finite(t.e_rv_real) && finite(t.e_rv_virtual);
}

/// Mean of E_R over the pixels in which virtual geometry changes it; 0 without any.
glm::dvec3 mean_real_irradiance(const Layers& layers) {
    std::vector<RealIrradiance> rows(std::size_t(layers.m.height));
    parallel_rows(layers.m.height, [&](int y) {
        RealIrradiance& row = rows[std::size_t(y)];
        for (int x = 0; x < layers.m.width; ++x) {
            const Terms t = terms_at(layers, layers.m.index(x, y));
            if (!finite(t) || t.e_r == t.e_rv_real) continue;
            row.sum += t.e_r;
            ++row.pixels;
        }
    });
    RealIrradiance all;
    for (const RealIrradiance& row : rows) {
        all.sum += row.sum;
        all.pixels += row.pixels;
    }
    return all.pixels == 0 ? glm::dvec3(0) : all.sum / double(all.pixels);
}

/// The photograph's share of the pixel before it is weighted with M.
double relit(double camera, double e_r, double e_rv, double epsilon, const BlendSettings& s) {
    return s.form == BlendForm::additive
               ? additive_change(camera, e_r, e_rv)
               : camera * bounded_ratio(e_r, e_rv, epsilon, double(s.max_ratio));
}

BlendedPixel blend_pixel(const Rgb& camera, const Terms& t, const glm::dvec3& epsilon,
                         const BlendSettings& settings) {
    if (!finite(t)) return {camera, true, true};
    const double m = std::clamp(t.m, 0.0, 1.0);
    if (m == 1 && t.e_r == t.e_rv_real) return {camera, true, false};
    BlendedPixel result;
    for (int c = 0; c < 3; ++c) {
        const double real =
            relit(double(camera[c]), t.e_r[c], t.e_rv_real[c], epsilon[c], settings);
        const double value = (1 - m) * (t.k_v[c] * t.e_rv_virtual[c] + t.s_rv[c]) + m * real;
        if (!(value <= double(std::numeric_limits<float>::max()))) return {camera, true, true};
        result.linear[c] = float(std::max(value, 0.0));
    }
    return result;
}

template <class Pixel>
void check_size(const Image<Pixel>& layer, const Photo& photo, const char* name) {
    require(layer.empty() || same_size(layer, photo.linear),
            std::string("layer ") + name + " is " + std::to_string(layer.width) + " x " +
                std::to_string(layer.height) + " px, the photograph " +
                std::to_string(photo.linear.width) + " x " + std::to_string(photo.linear.height) +
                " px: trace with the photograph's lens");
}

void check_sizes(const Photo& photo, const Layers& layers) {
    require(same_size(layers.m, photo.linear) && same_size(photo.encoded, photo.linear),
            "layer M and both forms of the photograph must have one size");
    check_size(layers.k_v, photo, "k_V");
    check_size(layers.s_rv, photo, "S_RV");
    for (const Irradiance* e : {&layers.direct, &layers.indirect}) {
        check_size(e->e_r, photo, "E_R");
        check_size(e->e_rv_real, photo, "E_RV_real");
        check_size(e->e_rv_virtual, photo, "E_RV_virtual");
    }
}

void add_counts(Composite& result, const std::vector<RowCounts>& rows) {
    for (const RowCounts& row : rows) {
        result.virtual_pixels += row.virtual_pixels;
        result.influenced_pixels += row.influenced;
        result.replaced_pixels += row.replaced;
    }
}

}  // namespace

void validate(const BlendSettings& s) {
    require(s.epsilon_share > 0 && s.epsilon_share <= 1,
            "blend.epsilon_share must lie in (0, 1], found " + std::to_string(s.epsilon_share),
            ExitCode::usage);
    require(s.max_ratio >= 1 && s.max_ratio <= 1e6f,
            "blend.max_ratio must lie in 1..1e6, found " + std::to_string(s.max_ratio),
            ExitCode::usage);
}

double bounded_ratio(double e_r, double e_rv, double epsilon, double max_ratio) {
    const double numerator = std::max(e_rv, 0.0) + epsilon;
    const double denominator = std::max(e_r, 0.0) + epsilon;
    if (e_r == e_rv || numerator == denominator) return 1;
    if (numerator >= max_ratio * denominator) return max_ratio;
    return numerator / denominator;
}

double additive_change(double camera, double e_r, double e_rv) {
    if (e_r == e_rv) return camera;
    const double reflected = std::numbers::pi * camera;
    const double k = reflected >= e_r ? (camera > 0 ? 1.0 : 0.0) : reflected / e_r;
    return std::max(camera + k / std::numbers::pi * (e_rv - e_r), 0.0);
}

Composite composite(const Photo& photo, const Layers& layers, const BlendSettings& settings) {
    validate(settings);
    check_sizes(photo, layers);
    const glm::dvec3 epsilon = double(settings.epsilon_share) * mean_real_irradiance(layers);
    Composite result{.display = photo.encoded, .linear = photo.linear};
    std::vector<RowCounts> rows(std::size_t(photo.linear.height));
    parallel_rows(photo.linear.height, [&](int y) {
        RowCounts& row = rows[std::size_t(y)];
        for (int x = 0; x < photo.linear.width; ++x) {
            const std::size_t i = photo.linear.index(x, y);
            const Terms terms = terms_at(layers, i);
            const BlendedPixel pixel =
                blend_pixel(photo.linear.pixels[i], terms, epsilon, settings);
            row.replaced += pixel.replaced ? 1 : 0;
            row.virtual_pixels += !std::isnan(terms.m) && terms.m < 1 ? 1 : 0;
            if (pixel.as_recorded) continue;
            result.linear.pixels[i] = pixel.linear;
            result.display.pixels[i] = encode(pixel.linear * photo.exposure);
            row.influenced += result.display.pixels[i] != photo.encoded.pixels[i] ? 1 : 0;
        }
    });
    add_counts(result, rows);
    return result;
}

}  // namespace inlay
