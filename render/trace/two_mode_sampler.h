// The two-mode sampler: irradiance with real geometry alone and with real and virtual geometry,
// from the same samples (Mehta 2015, sec. 6.5 and Algorithm 1, corrected) or by their difference.
#pragma once

#include "render/sample/environment_sampler.h"
#include "render/trace/embree_scene.h"
#include "render/trace/layers.h"
#include "render/trace/ray_counts.h"
#include "render/trace/real_geometry.h"

#include <cstdint>
#include <functional>

namespace inlay {

/// How the light on real surfaces is sampled in both modes.
enum class Estimator {
    two_mode,   // E_R and E_RV from the same samples (Mehta 2015, ch. 6)
    difference  // E_RV - E_R from samples of its own, drawn towards virtual geometry; then E_R
};

struct SamplingSettings {
    Estimator estimator = Estimator::two_mode;
    int primary = 4;    // camera rays per pixel
    int secondary = 4;  // light samples per camera ray; with `difference`, E_R gets fewer
                        // where the change is too small to be seen
    int coverage = 32;  // camera rays per pixel that decide M and k_V where virtual surfaces are
                        // in view; light is gathered by the first `primary` of them, and on virtual
                        // surfaces by `virtual_repeats` times as many
    int virtual_repeats = 8;  // camera rays whose light is sampled where they meet virtual
                              // surfaces, for each one on real surfaces: there the ratio E_RV / E_R
                              // and wide filters hide most of the noise
    int light_tries = 4;  // difference: directions from the environment per light sample that are
                          // tried against the bounds of virtual geometry
    int gathered = 64;    // difference: samples of E_R per vertex of the real mesh, kept from frame
                          // to frame where the scene brings a ModelLight, and fewer where it
                          // hardly shows; not used where pixels take more samples (primary x
                          // secondary) than that, so that E_R converges with them
    bool spread = true;   // samples of neighboring pixels are stratified together, as blue noise;
                          // false: each pixel's for itself
    std::uint32_t seed = 1;
    float depth_tolerance =
        0.0f;  // share of depth by which real surfaces must be nearer to hide virtual ones
    float occluder_floor = 0.02f;  // share of depth: occluders nearer than this count as this far
    float ignored_luminance =
        0.1f;  // occluders of light below this share of the mean do not narrow the filter
    bool unshadowed = false;  // also sum direct light without shadows; nothing else changes
    // What a plan may leave out; where it says so rightly, the result is the same to the bit.
    bool virtual_seen = true;  // false: no camera ray can meet a virtual surface; layers of such
                               // surfaces are empty images
    bool glossy_seen = true;   // false: none can meet a glossy one; S_RV and B_rho are empty
};

/// Throws Error unless counts are positive (coverage: 0 or more) and shares within 0..1.
void validate(const SamplingSettings& settings);

/// N = `samples` as 4 primary x N/4 secondary; N x 1 below 4; coverage, unless it is 0, is N/4 at
/// least, so that edges get better with the light. Throws Error unless N > 0 and, from 4
/// on, a multiple of 4.
SamplingSettings with_samples(SamplingSettings settings, int samples);

struct ModelLight;

/// All that light meets in one frame, seen through `lens` from `world_from_camera`. References must
/// outlive the call.
struct TwoModeScene {
    Lens lens;
    Pose world_from_camera;
    const RealGeometry& real;
    const EmbreeScene& virtual_objects;
    const EnvironmentSampler& environment;
    ModelLight* model_light = nullptr;  // E_R as far as it is known, of this real geometry in this
                                        // environment; null: it is sampled afresh
};

struct TwoModeResult {
    NoisyLayers layers;
    RayCounts rays;
    RayCounts gathering;  // not in `rays`: what a ModelLight lacked, which no later frame traces
};

/// Says of which pixels E_R is needed (not 0), once it is known where virtual geometry meets light
/// samples on real surfaces, or where it changes their light (`touched`, not 0). The layers hold
/// all else if E_R is sampled for itself, and nothing yet if both modes share their samples.
using LightDemand = std::function<Image<std::uint8_t>(const Image<std::uint8_t>& touched,
                                                      const NoisyLayers& layers)>;

/// Samples every pixel; but where a `demand` is given, real surfaces only where it says so, and the
/// rays against virtual geometry come first. `frame` is part of the random numbers' key. Where no
/// sample of a pixel meets virtual geometry, its e_rv_real equals its e_r to the bit. Non-finite
/// samples are dropped and counted.
TwoModeResult sample_two_modes(const TwoModeScene& scene, const SamplingSettings& settings,
                               std::uint32_t frame, const LightDemand& demand = {});

}  // namespace inlay
