#include "render/baseline/with_previous.h"

#include "recordings/base/parallel.h"
#include "render/filter/layer_sizes.h"
#include "render/filter/receiver_planes.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace inlay {
namespace {

/// Share that the previous frame has in each pixel's mean, and where that frame saw the pixel (-1:
/// nowhere).
struct Match {
    Image<std::int32_t> source;
    Image<float> share;
};

/// Samples of a pixel on real surfaces or on virtual ones.
double samples_on(const NoisyLayers& layers, bool real, std::size_t i) {
    const float m = layers.m.pixels[i];
    return layers.samples * std::clamp(double(real ? m : 1 - m), 0.0, 1.0);
}

Match match(const NoisyLayers& now, const NoisyLayers& previous, bool real,
            const FilterSettings& settings) {
    const auto kind = real ? &NoisyLayers::real : &NoisyLayers::virtual_;
    PreparedReceiver receiver;
    receiver.receiver = cleaned(now.*kind);
    receiver.footprint = pixel_footprint(receiver.receiver, now.lens, now.world_from_camera);
    Match result{matching_pixels(receiver, now.world_from_camera, previous, cleaned(previous.*kind),
                                 settings),
                 Image<float>(now.lens.width, now.lens.height, 0.0f)};
    for (std::size_t i = 0; i < result.share.pixels.size(); ++i) {
        if (result.source.pixels[i] < 0) continue;
        const double before = samples_on(previous, real, std::size_t(result.source.pixels[i]));
        const double all = before + samples_on(now, real, i);
        if (all > 0) result.share.pixels[i] = float(before / all);
    }
    return result;
}

bool finite(const Rgb& c) { return std::isfinite(c.r + c.g + c.b); }

/// An image of this frame and the same of the previous one.
using ImagePair = std::pair<Image<Rgb>*, const Image<Rgb>*>;

/// Averages where all of the previous frame's values are finite, so that they share their weights.
void average(const Match& match, const std::vector<ImagePair>& pairs) {
    parallel_rows(match.source.height, [&](int y) {
        for (int x = 0; x < match.source.width; ++x) {
            if (match.source(x, y) < 0) continue;
            const auto from = std::size_t(match.source(x, y));
            const bool usable = std::all_of(pairs.begin(), pairs.end(), [&](const ImagePair& p) {
                return finite(p.second->pixels[from]);
            });
            if (!usable) continue;
            for (const auto& [image, before] : pairs) {
                Rgb& own = (*image)(x, y);
                own += match.share(x, y) * (before->pixels[from] - own);
            }
        }
    });
}

}  // namespace

NoisyLayers with_previous(const NoisyLayers& now, const NoisyLayers& previous,
                          const FilterSettings& settings) {
    validate(settings);
    require_layer_sizes(now);
    require_layer_sizes(previous);
    NoisyLayers result = now;
    std::vector<ImagePair> real, on_virtual;
    for (const auto light : {&NoisyLayers::direct, &NoisyLayers::indirect}) {
        real.emplace_back(&(result.*light).e_r, &(previous.*light).e_r);
        real.emplace_back(&(result.*light).e_rv_real, &(previous.*light).e_rv_real);
        on_virtual.emplace_back(&(result.*light).e_rv_virtual, &(previous.*light).e_rv_virtual);
    }
    if (same_size(now.unshadowed.real, now.m) && same_size(previous.unshadowed.real, previous.m)) {
        real.emplace_back(&result.unshadowed.real, &previous.unshadowed.real);
        on_virtual.emplace_back(&result.unshadowed.virtual_, &previous.unshadowed.virtual_);
    }
    if (any_object(now.real)) average(match(now, previous, true, settings), real);
    if (any_object(now.virtual_)) average(match(now, previous, false, settings), on_virtual);
    return result;
}

}  // namespace inlay
