// LightNets: environment samples drawn once for a frame, in sets that are each spread well, for
// estimators that try many directions and trace few.
#pragma once

#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"

#include <cstdint>
#include <span>
#include <vector>

namespace inlay {

/// `size` samples after `size` samples: each run is a (0,2)-net, Owen-scrambled for itself, warped
/// by the environment's tables, and so is each of its aligned parts whose length is a power of two.
struct LightNets {
    std::vector<LightSample> samples;
    int size = 0;  // of a net, a power of two

    /// Sample `index` of the nets that follow `first` (any number: nets repeat).
    const LightSample& at(std::uint32_t first, int index) const {
        const std::size_t at = std::size_t(first) * std::size_t(size) + std::size_t(index);
        return samples[at & (samples.size() - 1)];  // a power of two
    }
};

/// 32768 samples in nets of `wanted` (> 0), rounded up to a power of two and 4096 at most. `key` is
/// that of the random numbers; its sample is not used.
LightNets make_light_nets(const EnvironmentSampler& environment, int wanted, SampleKey key);

}  // namespace inlay
