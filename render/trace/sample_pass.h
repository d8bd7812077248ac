// SamplePass: one sample of 16 pixels, with everything that its estimators share and add to.
#pragma once

#include "render/sample/light_nets.h"
#include "render/trace/landing.h"
#include "render/trace/pixel_sums.h"
#include "render/trace/ray_counts.h"
#include "render/trace/two_mode_sampler.h"

#include <algorithm>
#include <array>
#include <bit>

namespace inlay {

/// Dimensions of the random numbers of a sample.
enum SampleDimension : std::uint32_t {
    position_in_pixel,
    light_direction,
    diffuse_lobe,
    glossy_lobe,
    light_at_hit,
    glossy_lobe_at_hit,
    lobe_or_light,
    change_by_light,
    change_by_cones,
    change_by_cones_again,
    first_path_dimension = 64  // of the path tracer behind exact real geometry
};

/// The runs of environment samples that a tile's pixels take on one kind of surface, each found
/// when it is first asked for.
struct LaneRuns {
    std::array<LightRun, packet_width> run{};
    std::array<int, packet_width> count{};  // of their samples; 0: not found yet
};
struct LightRuns {
    LaneRuns real, on_virtual;
};

struct SamplePass {
    const TwoModeScene& scene;
    const SamplingSettings& settings;
    const Landings& landings;
    SampleKeys keys;
    std::array<PixelSums, packet_width>& sums;
    RayCounts& rays;
    const LightNets& nets;  // the frame's environment samples
    LightRuns& runs;        // of them, of the tile's pixels
};

/// Environment samples that a pixel takes on one kind of surface, if both modes share them.
inline int light_samples_on(LandingKind kind, const SamplingSettings& s) {
    return s.primary * s.secondary * (kind == LandingKind::on_virtual ? s.virtual_repeats : 1);
}

/// The run of `count` environment samples that a pixel takes for one purpose.
inline LightRun light_run(const SamplePass& pass, const SampleKey& key, std::uint32_t dimension,
                          int count) {
    return pass.nets.run(key, dimension, int(std::bit_ceil(unsigned(count))));
}

/// The environment sample of a lane that landed on `kind`, of the `count` that its pixel takes
/// there.
inline const LightSample& light_sample(const SamplePass& pass, std::size_t lane, LandingKind kind,
                                       int count) {
    LaneRuns& runs = kind == LandingKind::on_virtual ? pass.runs.on_virtual : pass.runs.real;
    const SampleKey& key = pass.keys[lane];
    if (runs.count[lane] != count) {
        runs.run[lane] = light_run(pass, key, light_direction, count);
        runs.count[lane] = count;
    }
    return pass.nets.at(runs.run[lane], int(key.sample));
}

/// Point `key.sample` of the `count` that a pixel takes from its frame's set.
inline glm::vec2 point_of(const StratifiedSet& frame_set, const SampleKey& key, int count) {
    return run_of(frame_set, key.place, count).at(key.sample);
}

/// Whether light is bright enough for what blocks it to narrow the filter.
inline bool counts_as_occluded(const SamplePass& pass, const Rgb& radiance) {
    return luminance(radiance) >=
           pass.settings.ignored_luminance * pass.scene.environment.mean_luminance;
}

/// The sums of the kind of surface that a sample landed on.
inline ReceiverSums& receiver_of(PixelSums& sums, LandingKind kind) {
    return kind == LandingKind::real ? sums.real : sums.virtual_;
}

/// cos/r (1/m) of an occluder, with distances below the floor counted as the floor, and none below
/// the distance at which rays start.
inline float occluder_rate(const Landing& from, const glm::vec3& direction, float distance,
                           const SamplingSettings& settings) {
    const float cosine = std::max(0.0f, glm::dot(from.normal, direction));
    return cosine / std::max({distance, settings.occluder_floor * from.distance, surface_offset});
}

inline void widen(float& rate, float candidate) { rate = std::max(rate, candidate); }

}  // namespace inlay
