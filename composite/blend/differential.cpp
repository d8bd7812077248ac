#include "composite/blend/differential.h"

#include "recordings/base/check.h"
#include "recordings/base/lanes.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace inlay {
namespace {

/// Red, green, blue and a lane that stays 0. Double, so that sums and products of finite floats
/// stay finite.
using Channels = stdx::simd<double, stdx::simd_abi::deduce_t<double, 4>>;

/// The terms of eq. 6.2 at one pixel.
struct Terms {
    double m = 1;
    Channels k_v = 0, s_rv = 0, e_r = 0, e_rv_real = 0, e_rv_virtual = 0;
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
    Channels sum = 0;
    std::uint64_t pixels = 0;
};

/// `yes` where `set`, else `no`.
inline double choose(bool set, double yes, double no) { return set ? yes : no; }

inline Channels choose(const Channels::mask_type& set, const Channels& yes, const Channels& no) {
    Channels result = no;
    where(set, result) = yes;
    return result;
}

template <class Number>
Number at_least_zero(const Number& x) {
    return choose(x < 0.0, Number(0), x);
}

/// bounded_ratio() of one channel or of all. Where the quotient is not used, it is one by 1.
template <class Number>
Number ratio_of(const Number& e_r, const Number& e_rv, const Number& epsilon, double max_ratio) {
    const Number numerator = at_least_zero(e_rv) + epsilon;
    const Number denominator = at_least_zero(e_r) + epsilon;
    const auto same = e_r == e_rv || numerator == denominator;
    const auto bounded = numerator >= max_ratio * denominator;
    const Number quotient = numerator / choose(same || bounded, Number(1), denominator);
    return choose(same, Number(1), choose(bounded, Number(max_ratio), quotient));
}

/// additive_change() of one channel or of all.
template <class Number>
Number change_of(const Number& camera, const Number& e_r, const Number& e_rv) {
    const Number reflected = std::numbers::pi * camera;
    const auto bounded = reflected >= e_r;
    const Number most = choose(camera > 0.0, Number(1), Number(0));
    const Number k = choose(bounded, most, reflected / choose(bounded, Number(1), e_r));
    const Number changed = at_least_zero(camera + k / std::numbers::pi * (e_rv - e_r));
    return choose(e_r == e_rv, camera, changed);
}

/// Loads with a mask: a fourth float would lie beyond the last pixel.
Channels channels(const Rgb& color) {
    using FourFloats = stdx::rebind_simd_t<float, Channels>;
    const auto colored = FourFloats([](auto lane) { return float(lane); }) < 3;
    FourFloats floats = 0;
    where(colored, floats).copy_from(&color.r, stdx::element_aligned);
    return stdx::static_simd_cast<Channels>(floats);
}

/// The pixels of a layer; one black pixel for all of those of an empty image.
struct Plane {
    const Rgb* pixels;
    std::size_t step;

    Channels at(std::size_t i) const { return channels(pixels[i * step]); }
};

Plane plane_of(const Image<Rgb>& image) {
    static const Rgb black(0);
    return image.empty() ? Plane{&black, 0} : Plane{image.pixels.data(), 1};
}

/// Direct and indirect irradiance.
struct Sum {
    Plane direct, indirect;

    Channels at(std::size_t i) const { return direct.at(i) + indirect.at(i); }
};

/// Where the terms are read.
struct Planes {
    const Image<float>& m;
    Plane k_v, s_rv;
    Sum e_r, e_rv_real, e_rv_virtual;
};

Planes planes_of(const Layers& layers) {
    const Irradiance &d = layers.direct, &n = layers.indirect;
    return {.m = layers.m,
            .k_v = plane_of(layers.k_v),
            .s_rv = plane_of(layers.s_rv),
            .e_r = {plane_of(d.e_r), plane_of(n.e_r)},
            .e_rv_real = {plane_of(d.e_rv_real), plane_of(n.e_rv_real)},
            .e_rv_virtual = {plane_of(d.e_rv_virtual), plane_of(n.e_rv_virtual)}};
}

inline Terms terms_at(const Planes& planes, std::size_t i) {
    return {.m = planes.m.pixels[i],
            .k_v = planes.k_v.at(i),
            .s_rv = planes.s_rv.at(i),
            .e_r = planes.e_r.at(i),
            .e_rv_real = planes.e_rv_real.at(i),
            .e_rv_virtual = planes.e_rv_virtual.at(i)};
}

inline bool finite(const Terms& t) {
    return std::isfinite(t.m) && all_of(isfinite(t.k_v) && isfinite(t.s_rv) && isfinite(t.e_r) &&
                                        isfinite(t.e_rv_real) && isfinite(t.e_rv_virtual));
}

bool unchanged(const Terms& t) { return all_of(t.e_r == t.e_rv_real); }

/// Mean of E_R over the pixels in which virtual geometry changes it; 0 without any.
Channels mean_real_irradiance(const Planes& planes) {
    std::vector<RealIrradiance> rows(std::size_t(planes.m.height));
    parallel_rows(planes.m.height, [&](int y) {
        RealIrradiance row;
        for (int x = 0; x < planes.m.width; ++x) {
            const Terms t = terms_at(planes, planes.m.index(x, y));
            if (unchanged(t) || !finite(t)) continue;
            row.sum += t.e_r;
            ++row.pixels;
        }
        rows[std::size_t(y)] = row;
    });
    RealIrradiance all;
    for (const RealIrradiance& row : rows) {
        all.sum += row.sum;
        all.pixels += row.pixels;
    }
    return all.pixels == 0 ? Channels(0) : all.sum / double(all.pixels);
}

/// The photograph's share of the pixel before it is weighted with M.
Channels relit(const Channels& camera, const Terms& t, const Channels& epsilon,
               const BlendSettings& s) {
    return s.form == BlendForm::additive
               ? change_of(camera, t.e_r, t.e_rv_real)
               : camera * ratio_of(t.e_r, t.e_rv_real, epsilon, double(s.max_ratio));
}

BlendedPixel blend_pixel(const Rgb& camera, const Terms& t, const Channels& epsilon,
                         const BlendSettings& settings) {
    if (!finite(t)) return {camera, true, true};
    const double m = std::clamp(t.m, 0.0, 1.0);
    if (m == 1 && unchanged(t)) return {camera, true, false};
    const Channels real = relit(channels(camera), t, epsilon, settings);
    const Channels value = (1 - m) * (t.k_v * t.e_rv_virtual + t.s_rv) + m * real;
    if (!all_of(value <= double(std::numeric_limits<float>::max()))) return {camera, true, true};
    const Channels linear = at_least_zero(value);
    return {.linear = {float(linear[0]), float(linear[1]), float(linear[2])}};
}

/// Pixels of a row that are not as recorded.
struct ChangedPixels {
    std::vector<std::size_t> places;
    std::vector<Rgb> seen;  // at the photograph's exposure
};

/// Writes them as bytes; how many differ from the recorded ones.
std::uint64_t show(const ChangedPixels& changed, Image<EncodedRgb>& display) {
    std::vector<EncodedRgb> bytes(changed.seen.size());
    encode(changed.seen, bytes);
    std::uint64_t different = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        EncodedRgb& shown = display.pixels[changed.places[i]];
        different += shown != bytes[i] ? 1 : 0;
        shown = bytes[i];
    }
    return different;
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
    return ratio_of(e_r, e_rv, epsilon, max_ratio);
}

double additive_change(double camera, double e_r, double e_rv) {
    return change_of(camera, e_r, e_rv);
}

Composite composite(const Photo& photo, const Layers& layers, const BlendSettings& settings) {
    validate(settings);
    check_sizes(photo, layers);
    const Planes planes = planes_of(layers);
    const Channels epsilon = double(settings.epsilon_share) * mean_real_irradiance(planes);
    Composite result{.display = photo.encoded, .linear = photo.linear};
    std::vector<RowCounts> rows(std::size_t(photo.linear.height));
    parallel_rows(photo.linear.height, [&](int y) {
        RowCounts& row = rows[std::size_t(y)];
        ChangedPixels changed;
        for (int x = 0; x < photo.linear.width; ++x) {
            const std::size_t i = photo.linear.index(x, y);
            const Terms terms = terms_at(planes, i);
            const BlendedPixel pixel =
                blend_pixel(photo.linear.pixels[i], terms, epsilon, settings);
            row.replaced += pixel.replaced ? 1 : 0;
            row.virtual_pixels += !std::isnan(terms.m) && terms.m < 1 ? 1 : 0;
            if (pixel.as_recorded) continue;
            result.linear.pixels[i] = pixel.linear;
            changed.places.push_back(i);
            changed.seen.push_back(pixel.linear * photo.exposure);
        }
        row.influenced = show(changed, result.display);
    });
    add_counts(result, rows);
    return result;
}

}  // namespace inlay
