#include "render/sample/light_nets.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

constexpr int least_samples = 32768;
constexpr int least_runs = 256;
constexpr int largest_run = 4096;
constexpr int net_size = 16384;  // 32 x 32 pixels of 16 samples
constexpr std::uint32_t nets_dimension = 0x6e657473;

}  // namespace

LightRun LightNets::run(const SampleKey& key, std::uint32_t dimension, int length) const {
    // All are powers of two: no division in the tracer's inner loops.
    const int net_bits = std::countr_zero(unsigned(size));
    const int bits = std::min(std::countr_zero(unsigned(length)), net_bits);
    const int run_bits = net_bits - bits;
    const std::uint32_t last_run = (1U << run_bits) - 1;
    const std::uint32_t net = hash(hash(key.place >> run_bits, seed), dimension);
    const std::size_t in_net = shuffle_nested(key.place & last_run, net) & last_run;
    const std::size_t run = (std::size_t(net >> 16) << run_bits) + in_net;
    return {(run << bits) & (samples.size() - 1), hash(key.pixel ^ net) & ((1U << bits) - 1)};
}

LightNets make_light_nets(const EnvironmentSampler& environment, int wanted, SampleKey key) {
    require(wanted > 0, "light nets: a run needs a sample or more");
    const bool lit = environment.mean_luminance > 0;
    const int run = int(std::bit_ceil(unsigned(std::min(wanted, largest_run))));
    LightNets nets;
    nets.seed = hash(key.frame, key.seed);
    nets.size = lit ? net_size : run;
    const int count = lit ? std::max(least_samples, least_runs * run) / net_size : 1;
    nets.samples.resize(std::size_t(count) * std::size_t(nets.size));
    for (std::vector<float>& plane : nets.direction)
        plane.resize(nets.samples.size());
    parallel_for(int(nets.samples.size()), [&](int i) {
        SampleKey at = key;
        at.pixel = std::uint32_t(i / nets.size);
        at.sample = std::uint32_t(i % nets.size);
        LightSample& sample = nets.samples[std::size_t(i)];
        sample = sample_environment(environment, stratified_pair(at, nets_dimension));
        for (int axis = 0; axis < 3; ++axis)
            nets.direction[std::size_t(axis)][std::size_t(i)] = sample.direction[axis];
    });
    return nets;
}

}  // namespace inlay
