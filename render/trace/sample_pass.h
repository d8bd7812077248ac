// SamplePass: one sample of 16 pixels, with everything that its estimators share and add to.
#pragma once

#include "render/trace/landing.h"
#include "render/trace/pixel_sums.h"
#include "render/trace/ray_counts.h"
#include "render/trace/two_mode_sampler.h"

namespace inlay {

/// Dimensions of the random numbers of a sample.
enum SampleDimension : std::uint32_t {
    position_in_pixel,
    light_direction,
    diffuse_lobe,
    glossy_lobe,
    light_at_hit,
    lobe_or_light,
    first_path_dimension = 64  // of the path tracer behind exact real geometry
};

struct SamplePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const Landings& landings;
    SampleKeys keys;
    std::array<PixelSums, packet_width>& sums;
    RayCounts& rays;
};

/// The sums of the kind of surface that a sample landed on.
inline ReceiverSums& receiver_of(PixelSums& sums, LandingKind kind) {
    return kind == LandingKind::real ? sums.real : sums.virtual_;
}

}  // namespace inlay
