#include "render/sample/light_nets.h"

#include "recordings/base/check.h"
#include "recordings/base/parallel.h"

#include <algorithm>
#include <bit>

namespace inlay {
namespace {

constexpr int least_samples = 32768;
constexpr int least_nets = 256;
constexpr int largest_net = 4096;
constexpr std::uint32_t nets_dimension = 0x6e657473;

}  // namespace

LightNets make_light_nets(const EnvironmentSampler& environment, int wanted, SampleKey key) {
    require(wanted > 0, "light nets: a net needs a sample or more");
    LightNets nets;
    nets.size = int(std::bit_ceil(unsigned(std::min(wanted, largest_net))));
    const int count =
        environment.mean_luminance > 0 ? std::max(least_nets, least_samples / nets.size) : 1;
    nets.samples.resize(std::size_t(count) * std::size_t(nets.size));
    parallel_for(count, [&](int net) {
        SampleKey at = key;
        at.pixel = std::uint32_t(net);
        for (int i = 0; i < nets.size; ++i) {
            at.sample = std::uint32_t(i);
            nets.samples[std::size_t(net * nets.size + i)] =
                sample_environment(environment, stratified_pair(at, nets_dimension));
        }
    });
    return nets;
}

}  // namespace inlay
