#include "render/baseline/gaussian_irradiance.h"

#include "render/baseline/masked_blur.h"
#include "render/baseline/smooth_receivers.h"

namespace inlay {

Layers gaussian_irradiance(const NoisyLayers& now, double sigma) {
    require_width(sigma, "the Gaussian's sigma");
    return smooth_receivers(now, SmootherNeeds{.surface = false}, [sigma](FilterPlanes& planes) {
        blur_masked(planes.object, sigma, planes.channels);
    });
}

}  // namespace inlay
