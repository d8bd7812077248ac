// The filter's innermost loop, written without branches, so that it runs on several pairs at once.
#include "render/filter/filter_weight.h"

namespace inlay {

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
