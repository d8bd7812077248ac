#include "render/filter/light_demand.h"

#include "recordings/base/parallel.h"
#include "render/filter/receiver_planes.h"

#include <algorithm>

namespace inlay {
namespace {

/// Not 0 where a chosen pixel is within `reach` px along the row, then along the column: the reach
/// of a separable kernel.
Image<std::uint8_t> widened(const Image<std::uint8_t>& chosen, int reach) {
    const int width = chosen.width, height = chosen.height;
    Image<std::uint8_t> rows(width, height, 0), result(width, height, 0);
    parallel_rows(height, [&](int y) {
        for (int x = 0, last = -reach - 1; x < width + reach; ++x) {
            if (x < width && chosen(x, y) != 0) last = x;
            if (x >= reach && x - last <= 2 * reach) rows(x - reach, y) = 1;
        }
    });
    parallel_rows(height, [&](int y) {
        for (int v = std::max(0, y - reach); v <= std::min(height - 1, y + reach); ++v)
            for (int x = 0; x < width; ++x)
                result(x, y) |= rows(x, v);
    });
    return result;
}

/// There is little to gain from a closer look: what the frame before adds counts as all the rest.
bool covers_most(Image<std::uint8_t>& needed) {
    const auto count = std::count(needed.pixels.begin(), needed.pixels.end(), 0);
    if (double(count) > 0.1 * double(needed.pixels.size())) return false;
    std::fill(needed.pixels.begin(), needed.pixels.end(), std::uint8_t(1));
    return true;
}

/// Adds the pixels to which the frame before brings a change.
void add_changes_before(const NoisyLayers& now, const NoisyLayers& previous,
                        const FilterSettings& settings, Image<std::uint8_t>& chosen) {
    const Image<std::uint8_t> changed = changed_pixels(previous);
    PreparedReceiver receiver;  // its curvature has no part in this
    receiver.receiver = cleaned(now.real);
    receiver.footprint = pixel_footprint(receiver.receiver, now.lens, now.world_from_camera);
    const Image<std::int32_t> source = matching_pixels(receiver, now.world_from_camera, previous,
                                                       cleaned(previous.real), settings);
    for (std::size_t i = 0; i < chosen.pixels.size(); ++i)
        if (source.pixels[i] >= 0)
            chosen.pixels[i] |= changed.pixels[std::size_t(source.pixels[i])];
}

}  // namespace

Image<std::uint8_t> light_demand(const Image<std::uint8_t>& touched, const NoisyLayers& now,
                                 const NoisyLayers* previous, const FilterSettings& settings) {
    if (!settings.enabled) return touched;
    if (settings.temporal && !sampled_apart(now))
        return Image<std::uint8_t>(touched.width, touched.height, 1);
    // Where the composite shows a change, and from there where E_R is read.
    const int reach = 2 * settings.kernel_radius + settings.rate_reach;
    Image<std::uint8_t> needed = widened(touched, reach);
    const bool follows = settings.temporal && previous != nullptr;
    if (!follows || covers_most(needed)) return needed;
    if (!sampled_apart(*previous)) return needed;
    Image<std::uint8_t> changed = touched;
    add_changes_before(now, *previous, settings, changed);
    return widened(changed, reach);
}

}  // namespace inlay
