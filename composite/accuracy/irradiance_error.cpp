#include "composite/accuracy/irradiance_error.h"

#include "composite/accuracy/displacement.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace inlay {
namespace {

Rgb sum_of(const Irradiance& direct, const Irradiance& indirect, Image<Rgb> Irradiance::*kind,
           std::size_t i) {
    return (direct.*kind).pixels[i] + (indirect.*kind).pixels[i];
}

/// Of one irradiance, over pixels that real surfaces fill.
double relative_rmse(const LightPair& found, const LightPair& wanted,
                     Image<Rgb> Irradiance::*kind) {
    double error = 0, power = 0;
    const auto at = [&](const Layers& l, std::size_t i) {
        return sum_of(l.direct, l.indirect, kind, i);
    };
    for (std::size_t i = 0; i < wanted.a.m.pixels.size(); ++i) {
        if (found.a.m.pixels[i] < 1 || wanted.a.m.pixels[i] < 1) continue;
        const Rgb fa = at(found.a, i), fb = at(found.b, i);
        const Rgb wa = at(wanted.a, i), wb = at(wanted.b, i);
        const Rgb hole(0);  // of one of the surfaces
        if (fa == hole || fb == hole || wa == hole || wb == hole) continue;
        error += double(glm::dot(fa - wa, fb - wb));
        power += double(glm::dot(wa, wb));
    }
    return power > 0 ? std::sqrt(std::max(0.0, error) / power) : 0;
}

}  // namespace

IrradianceError irradiance_error(const LightPair& found, const LightPair& wanted) {
    std::size_t covered = 0, lit = 0;
    for (std::size_t i = 0; i < found.a.m.pixels.size(); ++i) {
        if (found.a.m.pixels[i] < 1 || wanted.a.direct.e_r.pixels[i] == Rgb(0)) continue;
        ++covered;
        if (found.a.direct.e_r.pixels[i] != Rgb(0)) ++lit;
    }
    return {relative_rmse(found, wanted, &Irradiance::e_r),
            relative_rmse(found, wanted, &Irradiance::e_rv_real),
            covered > 0 ? double(lit) / double(covered) : 0.0};
}

double displaced_irradiance(const LightPair& pair, Image<Rgb> Irradiance::*kind, double px) {
    Reference mean;
    const Image<Rgb>& size = pair.a.direct.*kind;
    mean.linear = mean.standard_error = Image<Rgb>(size.width, size.height, Rgb(0));
    mean.finite = mean.influenced = Mask(size.width, size.height);
    double power = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size.pixels.size(); ++i) {
        const Rgb a = sum_of(pair.a.direct, pair.a.indirect, kind, i);
        const Rgb b = sum_of(pair.b.direct, pair.b.indirect, kind, i);
        mean.linear.pixels[i] = 0.5f * (a + b);
        mean.standard_error.pixels[i] = 0.5f * glm::abs(a - b);
        const bool counted = pair.a.m.pixels[i] >= 1 && a != Rgb(0) && b != Rgb(0);
        mean.finite.pixels[i] = mean.influenced.pixels[i] = counted;
        if (!counted) continue;
        power += double(glm::dot(a, b)) / 3;
        ++count;
    }
    if (!(power > 0)) return 0;
    return std::sqrt(displaced_mean_square(mean, px) / (power / double(count)));
}

}  // namespace inlay
