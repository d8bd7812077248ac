#include "render/filter/layer_sizes.h"

#include "recordings/base/check.h"

#include <cstddef>
#include <string>

namespace inlay {
namespace {

template <class Pixel>
void require_size(const NoisyLayers& layers, const Image<Pixel>& image, const char* name) {
    require(image.width == layers.lens.width && image.height == layers.lens.height &&
                image.pixels.size() == std::size_t(image.width) * std::size_t(image.height),
            std::string("noisy layers: ") + name + " is " + std::to_string(image.width) + " x " +
                std::to_string(image.height) + " px, expected the lens's " +
                std::to_string(layers.lens.width) + " x " + std::to_string(layers.lens.height));
}

void check(const NoisyLayers& layers, const Irradiance& light) {
    require_size(layers, light.e_r, "e_r");
    require_size(layers, light.e_rv_real, "e_rv_real");
    if (!layers.k_v.empty()) require_size(layers, light.e_rv_virtual, "e_rv_virtual");
}

void check(const NoisyLayers& layers, const Receiver& receiver) {
    require_size(layers, receiver.object, "object");
    require_size(layers, receiver.position, "position");
    require_size(layers, receiver.normal, "normal");
    require_size(layers, receiver.occluder_direct, "occluder_direct");
    require_size(layers, receiver.occluder_indirect, "occluder_indirect");
}

}  // namespace

void require_layer_sizes(const NoisyLayers& layers) {
    require_size(layers, layers.m, "m");
    check(layers, layers.direct);
    check(layers, layers.indirect);
    check(layers, layers.real);
    if (!layers.change_rates.direct.empty() || !layers.change_rates.indirect.empty()) {
        require_size(layers, layers.change_rates.direct, "change_rates.direct");
        require_size(layers, layers.change_rates.indirect, "change_rates.indirect");
    }
    if (layers.k_v.empty()) return;
    require_size(layers, layers.k_v, "k_v");
    check(layers, layers.virtual_);
    if (layers.s_rv.empty()) return;
    require_size(layers, layers.s_rv, "s_rv");
    require_size(layers, layers.glossy_bandwidth, "glossy_bandwidth");
}

void require_unshadowed(const NoisyLayers& layers) {
    require_size(layers, layers.unshadowed.real, "unshadowed.real");
    if (!layers.k_v.empty())
        require_size(layers, layers.unshadowed.virtual_, "unshadowed.virtual_");
}

}  // namespace inlay
