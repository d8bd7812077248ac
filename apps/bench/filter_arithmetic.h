// What the environment filter's kernels compute for a frame, apart from the memory they go through.
#pragma once

#include "render/filter/filter_settings.h"
#include "render/trace/layers.h"

#include <functional>

namespace inlay {

struct KernelWork {
    double weights = 0;        // of pairs of pixels
    double multiply_adds = 0;  // of a weight and a difference, one for each pixel and channel
};

/// Of all kernels that filter_layers() runs over a frame whose modes share their samples.
KernelWork kernel_work(const NoisyLayers& now, bool with_previous, const FilterSettings& settings);

/// A function that computes as much, on all threads, from numbers that stay in the nearest cache.
std::function<void()> arithmetic(const KernelWork& work);

}  // namespace inlay
