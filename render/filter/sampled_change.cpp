#include "render/filter/sampled_change.h"

#include "recordings/base/parallel.h"

namespace inlay {

Image<Rgb> change_of(const Irradiance& light) {
    Image<Rgb> change(light.e_r.width, light.e_r.height);
    parallel_rows(change.height, [&](int y) {
        for (int x = 0; x < change.width; ++x)
            change(x, y) = light.e_rv_real(x, y) - light.e_r(x, y);
    });
    return change;
}

Image<Rgb> with_change(const Image<Rgb>& e_r, const Image<Rgb>& change) {
    Image<Rgb> result(e_r.width, e_r.height);
    parallel_rows(result.height, [&](int y) {
        for (int x = 0; x < result.width; ++x)
            result(x, y) = glm::max(e_r(x, y) + change(x, y), 0.0f);
    });
    return result;
}

Receiver receiver_of_change(const NoisyLayers& layers) {
    Receiver result = layers.real;
    result.occluder_direct = layers.change_rates.direct;
    result.occluder_indirect = layers.change_rates.indirect;
    return result;
}

}  // namespace inlay
