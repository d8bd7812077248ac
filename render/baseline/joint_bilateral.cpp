#include "render/baseline/joint_bilateral.h"

#include "render/baseline/smooth_receivers.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace inlay {

Layers joint_bilateral(const NoisyLayers& now, double sigma, const SurfaceGuide& guide) {
    require_width(sigma, "the bilateral filter's sigma");
    validate(guide);
    return smooth_receivers(now, {}, [&](FilterPlanes& planes) {
        const int longest = std::max(planes.object.width, planes.object.height);
        const int radius = int(std::min(std::ceil(2 * sigma), double(longest)));
        const AddExponents surface =
            surface_exponents(planes, now.world_from_camera.translation, guide);
        planes.channels = weighted_means(planes.object, planes.channels, nullptr,
                                         gaussian_taps(radius, sigma), surface)
                              .channels;
    });
}

}  // namespace inlay
