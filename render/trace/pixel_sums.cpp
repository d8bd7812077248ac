#include "render/trace/pixel_sums.h"

#include <algorithm>
#include <numbers>

namespace inlay {
namespace {

void store(const ReceiverSums& sums, std::size_t i, Receiver& receiver) {
    if (sums.hits == 0) return;
    receiver.object.pixels[i] = sums.object;
    receiver.position.pixels[i] = glm::vec3(sums.position / double(sums.hits));
    const double length = glm::length(sums.normal);
    receiver.normal.pixels[i] = length > 0 ? glm::vec3(sums.normal / length) : glm::vec3(0, 0, 1);
    receiver.occluder_direct.pixels[i] = sums.occluder_direct;
    receiver.occluder_indirect.pixels[i] = sums.occluder_indirect;
}

void store(const ChangeSums& sums, std::size_t i, NoisyLayers& layers) {
    const double rays = std::max(sums.camera_rays, 1);
    layers.direct.e_rv_real.pixels[i] = layers.direct.e_r.pixels[i] + Rgb(sums.direct / rays);
    layers.indirect.e_rv_real.pixels[i] = layers.indirect.e_r.pixels[i] + Rgb(sums.indirect / rays);
    layers.change_rates.direct.pixels[i] = sums.rate_direct;
    layers.change_rates.indirect.pixels[i] = sums.rate_indirect;
    layers.change_rates.share.pixels[i] = float(sums.hidden / rays / std::numbers::pi);
}

/// What is known of the virtual surfaces at a pixel.
void store_virtual(const PixelSums& sums, std::size_t i, NoisyLayers& layers) {
    layers.k_v.pixels[i] = sums.albedo.mean() / std::numbers::pi_v<float>;
    layers.direct.e_rv_virtual.pixels[i] = sums.direct_virtual.mean();
    layers.indirect.e_rv_virtual.pixels[i] = sums.indirect_virtual.mean();
    if (!layers.s_rv.empty()) {
        layers.s_rv.pixels[i] = sums.glossy_direct.mean() + sums.glossy_indirect.mean();
        layers.glossy_bandwidth.pixels[i] = sums.glossy_bandwidth;
    }
    if (!layers.unshadowed.virtual_.empty())
        layers.unshadowed.virtual_.pixels[i] = sums.unshadowed_virtual.mean();
    store(sums.virtual_, i, layers.virtual_);
}

Receiver make_receiver(int width, int height) {
    return {Image<std::uint32_t>(width, height), Image<glm::vec3>(width, height),
            Image<glm::vec3>(width, height), Image<float>(width, height),
            Image<float>(width, height)};
}

Irradiance make_irradiance(int width, int height, bool on_virtual) {
    return {Image<Rgb>(width, height), Image<Rgb>(width, height),
            on_virtual ? Image<Rgb>(width, height) : Image<Rgb>{}};
}

}  // namespace

void store(const PixelSums& sums, int x, int y, NoisyLayers& layers) {
    const std::size_t i = layers.m.index(x, y);
    layers.m.pixels[i] = sums.looks > 0 ? 1 - float(sums.looks_virtual) / float(sums.looks) : 1.0f;
    layers.direct.e_r.pixels[i] = sums.direct.e_r.mean();
    layers.direct.e_rv_real.pixels[i] = sums.direct.e_rv.mean();
    layers.indirect.e_r.pixels[i] = sums.indirect.e_r.mean();
    layers.indirect.e_rv_real.pixels[i] = sums.indirect.e_rv.mean();
    if (!layers.change_rates.direct.empty()) store(sums.change, i, layers);
    if (!layers.unshadowed.real.empty())
        layers.unshadowed.real.pixels[i] = sums.unshadowed_real.mean();
    store(sums.real, i, layers.real);
    if (!layers.k_v.empty()) store_virtual(sums, i, layers);
}

void store_real_light(const PixelSums& sums, int x, int y, NoisyLayers& layers) {
    const std::size_t i = layers.m.index(x, y);
    const auto add = [i](const PairedSum& light, Irradiance& to) {
        to.e_r.pixels[i] = light.e_r.mean();
        to.e_rv_real.pixels[i] += to.e_r.pixels[i];
    };
    add(sums.direct, layers.direct);
    add(sums.indirect, layers.indirect);
    layers.real.occluder_direct.pixels[i] = sums.real.occluder_direct;
    layers.real.occluder_indirect.pixels[i] = sums.real.occluder_indirect;
    if (!layers.unshadowed.real.empty())
        layers.unshadowed.real.pixels[i] = sums.unshadowed_real.mean();
}

Image<std::uint8_t> changed_pixels(const NoisyLayers& layers) {
    Image<std::uint8_t> changed(layers.m.width, layers.m.height, 0);
    for (std::size_t i = 0; i < changed.pixels.size(); ++i)
        changed.pixels[i] = layers.direct.e_rv_real.pixels[i] != layers.direct.e_r.pixels[i] ||
                            layers.indirect.e_rv_real.pixels[i] != layers.indirect.e_r.pixels[i];
    return changed;
}

NoisyLayers make_noisy_layers(const Lens& lens, const Pose& world_from_camera,
                              const SamplingSettings& settings) {
    const int w = lens.width, h = lens.height;
    NoisyLayers layers;
    layers.lens = lens;
    layers.world_from_camera = world_from_camera;
    layers.samples = settings.primary * settings.secondary;
    layers.m = Image<float>(w, h, 1.0f);
    layers.direct = layers.indirect = make_irradiance(w, h, settings.virtual_seen);
    layers.real = make_receiver(w, h);
    if (settings.estimator == Estimator::difference)
        layers.change_rates = {Image<float>(w, h), Image<float>(w, h), Image<float>(w, h)};
    if (!settings.virtual_seen) return layers;
    layers.k_v = Image<Rgb>(w, h);
    layers.virtual_ = make_receiver(w, h);
    if (!settings.glossy_seen) return layers;
    layers.s_rv = Image<Rgb>(w, h);
    layers.glossy_bandwidth = Image<float>(w, h);
    return layers;
}

int dropped(const PixelSums& sums) {
    return sums.direct.e_r.dropped + sums.indirect.e_r.dropped + sums.direct_virtual.dropped +
           sums.indirect_virtual.dropped + sums.glossy_direct.dropped +
           sums.glossy_indirect.dropped + sums.albedo.dropped + sums.change.dropped;
}

}  // namespace inlay
