#include "render/filter/shadow_ratio.h"

#include "recordings/base/parallel.h"

#include <limits>

namespace inlay {

void scale_to_open_sky(const EnvironmentIrradiance& open_sky, const Receiver& receiver,
                       const Image<Rgb>& unshadowed, Image<Rgb>& light) {
    parallel_rows(light.height, [&](int y) {
        for (int x = 0; x < light.width; ++x) {
            if (receiver.object(x, y) == 0) continue;
            const Rgb open = irradiance_on(open_sky, receiver.normal(x, y));
            for (int c = 0; c < 3; ++c) {
                const float u = unshadowed(x, y)[c];
                light(x, y)[c] =
                    u >= std::numeric_limits<float>::min() ? open[c] * (light(x, y)[c] / u) : 0.0f;
            }
        }
    });
}

}  // namespace inlay
