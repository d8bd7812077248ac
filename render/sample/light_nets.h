// LightNets: a frame's environment samples, drawn once, in well spread runs for pixels to share.
#pragma once

#include "recordings/base/random.h"
#include "render/sample/environment_sampler.h"

#include <cstdint>
#include <vector>

namespace inlay {

/// Samples in nets of `size`: each is a (0,2)-net, Owen-scrambled for itself and warped by the
/// environment's tables, and so is each of its aligned runs whose length is a power of two.
struct LightNets {
    std::vector<LightSample> samples;  // a power of two of them
    int size = 0;                      // of a net, a power of two

    /// Sample `index` counted from the start of run `first` (any number: runs repeat) of those
    /// whose length is `length`, a power of two: as many as one pixel takes, so that few pixels
    /// share theirs. Beyond it the next run follows.
    const LightSample& at(std::uint32_t first, int length, int index) const {
        const std::size_t at = std::size_t(first) * std::size_t(length) + std::size_t(index);
        return samples[at & (samples.size() - 1)];
    }
};

/// Nets of `wanted` (> 0) samples, rounded up to a power of two and 4096 at most; 256 nets and
/// 32768 samples, or more. One net where the environment sends no light. `key` is that of the
/// random numbers; its pixel and sample are not used.
LightNets make_light_nets(const EnvironmentSampler& environment, int wanted, SampleKey key);

}  // namespace inlay
