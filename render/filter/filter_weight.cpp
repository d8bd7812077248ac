// The filter's innermost loop, written without branches, so that it runs on several pairs at once.
#include "render/filter/filter_weight.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

/// exp(-x) for x >= 0 within 2e-7 relative, exactly 1 at 0, and e^-60 beyond 60 (nothing, in a mean
/// that holds its own pixel with weight 1) where `keep` is 1; 0 where it is 0. No branch: bits are
/// masked, and numbers that are not negative compare as their bits do.
float exp_minus(float x, std::int32_t keep) {
    const std::int32_t bounded =
        std::min(std::bit_cast<std::int32_t>(x), std::bit_cast<std::int32_t>(60.0f));
    const float power = std::bit_cast<float>(bounded) * -1.44269504f;
    const auto whole = static_cast<std::int32_t>(power - 0.5f);
    const float f = power - static_cast<float>(whole);  // -0.5 .. 0.5; Taylor series of 2^f
    const float mantissa =
        1.0f + f * (0.693147181f +
                    f * (0.240226507f +
                         f * (0.0555041087f +
                              f * (0.00961812911f + f * (0.00133335581f + f * 0.000154035304f)))));
    const std::int32_t bits = std::bit_cast<std::int32_t>(mantissa) + whole * (1 << 23);
    return std::bit_cast<float>(bits & -keep);
}

}  // namespace

void weigh(const PixelRun& a, const PixelRun& b, int count, float normal_cosine,
           float* __restrict weights) {
    const float *ax = a.position[0], *ay = a.position[1], *az = a.position[2];
    const float *bx = b.position[0], *by = b.position[1], *bz = b.position[2];
    const float *au = a.normal[0], *av = a.normal[1], *aw = a.normal[2];
    const float *bu = b.normal[0], *bv = b.normal[1], *bw = b.normal[2];
    const float *ap = a.precision, *bp = b.precision;
    const std::uint32_t *ao = a.object, *bo = b.object;
    for (int k = 0; k < count; ++k) {
        const float dx = bx[k] - ax[k], dy = by[k] - ay[k], dz = bz[k] - az[k];
        const float square = dx * dx + dy * dy + dz * dz;
        const float cosine = au[k] * bu[k] + av[k] * bv[k] + aw[k] * bw[k];
        const std::int32_t alike =
            std::int32_t(ao[k] == bo[k]) & std::int32_t(cosine >= normal_cosine);
        weights[k] = exp_minus(0.25f * (ap[k] + bp[k]) * square, alike);
    }
}

}  // namespace inlay
