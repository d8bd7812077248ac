// LightNets: a frame's environment samples, drawn once, in well spread runs for pixels to share.
#pragma once

#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace inlay {

/// The run of a pixel for one purpose.
struct LightRun {
    std::size_t first = 0;    // its start
    std::uint32_t order = 0;  // its samples change places by this: a few of them are any of them
};

/// Samples in nets of `size`: each is a (0,2)-net, Owen-scrambled for itself and warped by the
/// environment's tables, and so is each of its aligned runs whose length is a power of two.
struct LightNets {
    std::vector<LightSample> samples;
    std::array<std::vector<float>, 3> direction;  // theirs, a plane for each coordinate
    int size = 0;                                 // of a net, a power of two
    std::uint32_t seed = 0;                       // of which pixels take which run

    /// `length` samples, a power of two; more than `size` of them go on in the next net. Pixels
    /// next to each other along the curve (SampleKey::place) take runs of one net, in an order of
    /// their own, so that together they are spread as well as a net (Ahmed and Wonka 2020).
    LightRun run(const SampleKey& key, std::uint32_t dimension, int length) const;

    /// Where sample `index` of a run stands; beyond its end the next run follows. Eight of them
    /// from a multiple of eight on stand together, in another order, from `first_of_eight` on.
    std::size_t place_of(const LightRun& run, int index) const {
        return (run.first + (std::size_t(index) ^ run.order)) & (samples.size() - 1);
    }
    std::size_t first_of_eight(const LightRun& run, int index) const {
        return place_of(run, index) & ~std::size_t(7);
    }
    const LightSample& at(const LightRun& run, int index) const {
        return samples[place_of(run, index)];
    }
};

/// Nets that hold runs of `wanted` (> 0) samples, rounded up to a power of two and 4096 at most,
/// for many pixels: 32768 samples in all, and 256 runs, or more. One run where the environment
/// sends no light. `key` is that of the random numbers; its pixel and sample are not used.
LightNets make_light_nets(const EnvironmentSampler& environment, int wanted, SampleKey key);

}  // namespace inlay
