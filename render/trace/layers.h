// What the sampler hands to the filter, and the filter to the compositor: the terms of Mehta 2015,
// eq. 6.2, per pixel. Symbols as there: E irradiance, k albedo / pi, M coverage by real surfaces; R
// = real geometry alone, RV = real and virtual.
#pragma once

#include "recordings/base/color.h"
#include "recordings/base/image.h"
#include "recordings/base/lens.h"
#include "recordings/base/pose.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>

namespace inlay {

/// Irradiances of one kind of light (direct or indirect), each the mean over its own samples: those
/// on real surfaces for the first two, those on virtual ones for the third. Where the change was
/// sampled for itself, the second is the first plus that change, and may be negative.
struct Irradiance {
    Image<Rgb> e_r;           // real geometry alone, on real surfaces
    Image<Rgb> e_rv_real;     // real and virtual geometry, on real surfaces
    Image<Rgb> e_rv_virtual;  // real and virtual geometry, on virtual surfaces
};

/// The surface that receives light at a pixel, mean over the primary samples that met its kind
/// (real or virtual), with what the filter needs to know about the geometry around it.
struct Receiver {
    Image<std::uint32_t> object;  // 0: no sample of this kind here; else 1 + the object's index
    Image<glm::vec3> position;    // m, world
    Image<glm::vec3> normal;      // unit, world
    Image<float>
        occluder_direct;  // largest cos/r (1/m) over shadow rays that were blocked, 0: none
    Image<float> occluder_indirect;  // largest cos/r (1/m) over indirect rays that hit, 0: none
};

/// Direct light as if nothing were in its way, from the same samples as the shadowed; empty images:
/// not sampled.
struct Unshadowed {
    Image<Rgb> real;      // goes with direct e_r and e_rv_real, and equals both where all is open
    Image<Rgb> virtual_;  // goes with direct e_rv_virtual
};

/// How fast E_RV - E_R may vary on a real surface, where that change was sampled for itself:
/// largest cos/r (1/m) of the virtual surfaces met, 0: none. Empty images: both modes shared their
/// samples.
struct ChangeRates {
    Image<float> direct, indirect;
    Image<float> share;  // of an even sky's irradiance that virtual surfaces hide: estimated,
                         // 0..1 in the mean
};

/// Per-pixel Monte Carlo estimates of one frame, with the camera that saw them.
struct NoisyLayers {
    Lens lens;
    Pose world_from_camera;
    int samples = 0;          // of light, per pixel: primary x secondary
    int virtual_samples = 0;  // the same where virtual surfaces receive; 0: as `samples`
    Image<float> m;           // M: share of all camera rays that met real surfaces or nothing, 0..1
    Image<Rgb> k_v;   // k_V: mean albedo / pi over the samples on virtual surfaces; empty, as all
                      // that is said of such surfaces, where none can be seen
    Image<Rgb> s_rv;  // S_RV: mean glossy radiance over the samples on virtual surfaces; empty, as
                      // B_rho, where no glossy one can be seen
    Image<float> glossy_bandwidth;  // B_rho (1/rad) of the glossy lobe, 0: no glossy surface here
    Irradiance direct, indirect;
    ChangeRates change_rates;
    Receiver real;                      // cos/r: the larger of both modes; R alone if sampled apart
    Receiver virtual_;                  // real geometry counts as occluder too
    std::uint64_t dropped_samples = 0;  // non-finite ones, left out of every mean
    Unshadowed unshadowed;              // empty unless asked for
    Image<std::uint8_t> sampled_real;   // 0: real surfaces got no samples of E_R, which counts as
                                        // 0, with no rates; empty: all got them
};

/// Whether E_RV - E_R was sampled for itself.
inline bool sampled_apart(const NoisyLayers& layers) { return !layers.change_rates.direct.empty(); }

/// 1 where virtual geometry changes the light of a real surface.
Image<std::uint8_t> changed_pixels(const NoisyLayers& layers);

/// Light samples per pixel that virtual surfaces got.
inline int samples_on_virtual(const NoisyLayers& layers) {
    return layers.virtual_samples > 0 ? layers.virtual_samples : layers.samples;
}

/// The same terms after filtering, which is what eq. 6.2 combines.
struct Layers {
    Image<float> m;
    Image<Rgb> k_v, s_rv;
    Irradiance direct, indirect;
    Image<float> bandwidth_direct,
        bandwidth_indirect;  // 1/m, of the kind that covers more of the pixel
};

}  // namespace inlay
